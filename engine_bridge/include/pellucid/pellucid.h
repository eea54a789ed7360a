/* Pellucid behind an engine: the host draws its transparent geometry, in any order, with its own shaders; this library
   keeps the planes, the blending and the resolve. See INTEGRATION.md. C99, OpenGL 3.3 and later
   (4.3 for PLD_TIER_EXACT).

   Rules of the interface
   * Every call is made with the host's GL context current on the calling thread, the one that pld_create() saw.
   * No call throws, ends the process, or reads GL through anything but the host's get_proc_address. The library links
   no GL library and has no global state.
   * A call that fails changes no GL state and says why through the log and pld_message(). GL errors that are pending
     when a call is made stay pending, but for pld_create() and pld_resize(), which report them to the log and clear
   them.
   * Textures are the host's 2D textures, one sample a pixel, level 0. Rows may run up or down (pld_rows).
   * After pld_resize() and pld_shadow_resize() no memory is allocated and no GL object is made. */
#ifndef PELLUCID_H
#define PELLUCID_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define PLD_VERSION_MAJOR 0
#define PLD_VERSION_MINOR                                                                          \
  14 /* 0.2: shadow maps, rims, low resolution. 0.3: pld_fix(). 0.4: views of those of 0.2,        \
       rims in the published tier and with PLD_METHOD_FRONT_TAIL, low resolution that scatters,    \
       the exact tier; refraction and diffusion without PLD_FEATURE_LIGHT keep no light that adds, \
       which is implied for hosts of before. 0.5: PLD_FLAG_VALIDATE, pld_create_info.message; what \
       could be misused in silence is refused, and to hosts of before said as a warning.           \
       0.6: pld_frame.weight_reference. 0.7: PLD_METHOD_OVER, PLD_FEATURE_OUTPUTS,                 \
       PLD_FLAG_TRUST_TEXTURES. 0.9: recipe.h. 0.14: PLD_FEATURE_DEPTHS, _MOTION and _IDENTITY,    \
       pld_frame.depth_opacity; shadow maps in recipe.h.                                           \
       A library takes hosts of every earlier minor version. */
#define PLD_VERSION_PATCH 0
#define PLD_VERSION ((PLD_VERSION_MAJOR << 20) | (PLD_VERSION_MINOR << 10) | PLD_VERSION_PATCH)

#if defined(PLD_STATIC)
#define PLD_API
#elif defined(_WIN32)
#define PLD_API __declspec(dllimport)
#else
#define PLD_API __attribute__((visibility("default")))
#endif

/* Of 32 bits, whatever value a host puts there. */
#ifdef __cplusplus
#define PLD_ENUM(name) enum name : int32_t
extern "C" {
#else
#define PLD_ENUM(name) enum name
#endif

typedef struct pld_pass pld_pass; /* one view: its planes, its programs, its state */

typedef PLD_ENUM(pld_status){
    PLD_OK = 0,
    PLD_ERROR_ARGUMENT = 1,    /* a null pointer, or a value that no enumeration or range has */
    PLD_ERROR_VERSION = 2,     /* struct_size or version of another header than this library knows */
    PLD_ERROR_ORDER = 3,       /* not now: see the order of calls below */
    PLD_ERROR_SIZE = 4,        /* a texture or a size that does not fit */
    PLD_ERROR_TEXTURE = 5,     /* no 2D texture of this context: deleted, foreign, or of another kind */
    PLD_ERROR_FORMAT = 6,      /* a texture whose format cannot serve */
    PLD_ERROR_CONTEXT = 7,     /* the context of pld_create() is not current on this thread */
    PLD_ERROR_UNSUPPORTED = 8, /* neither this device nor this version has it */
    PLD_ERROR_MEMORY = 9,      /* the device, or the machine, has no room */
    PLD_ERROR_BUSY = 10,       /* another thread is inside a call with this pass */
    PLD_ERROR_INTERNAL = 11,   /* a mistake of this library; the message holds the driver's words */
    PLD_ERROR_MISUSE = 12      /* PLD_FLAG_VALIDATE: between a begin and its end the host did what it must not. The end
                                  has been made all the same, and the stage counts as drawn */
} pld_status;

/* As eglGetProcAddress, glXGetProcAddress, SDL_GL_GetProcAddress; `user` is passed through. */
typedef void (*pld_proc)(void);
typedef pld_proc (*pld_get_proc_address)(void* user, const char* name);

typedef PLD_ENUM(pld_log_level){PLD_LOG_ERROR = 0, PLD_LOG_WARNING = 1, PLD_LOG_INFO = 2} pld_log_level;
/* Called on the thread of the call that logs; `text` lives until it returns. */
typedef void (*pld_log)(void* user, pld_log_level level, const char* text);

typedef PLD_ENUM(pld_method){
    PLD_METHOD_PHENOMENOLOGICAL = 0, /* weighted sums, refraction and diffusion where the features ask */
    PLD_METHOD_WEIGHTED = 1,         /* the same sums; refuses the scattering features */
    PLD_METHOD_FRONT_TAIL =
        2, /* the nearest layer exactly over weighted sums; geometry is drawn twice, in the exact tier once */
    PLD_METHOD_OVER =
        3 /* the truth: all layers sorted by depth and composited in double precision, as `pellucid composite` does
             without a method. In PLD_TIER_EXACT alone; refuses the scattering features and low resolution. Reads no
             weight, keeps coloured transmission and light that adds without being asked */
} pld_method;

typedef PLD_ENUM(pld_tier){
    PLD_TIER_FLOAT = 0,     /* 32-bit float planes: the bits of the offline program on the same fragments and order */
    PLD_TIER_HALF = 1,      /* the same planes in 16-bit floats; sums are clamped at 65504 */
    PLD_TIER_PUBLISHED = 2, /* RGBA16F + RGBA8 + RG8_SNORM, as McGuire and Mara 2017 print them */
    PLD_TIER_EXACT = 3 /* the planes of PLD_TIER_FLOAT with bits that no order of draws changes: each the true sum of
                          its terms, rounded once. Needs OpenGL 4.3, seams of GLSL 430 and later, and room for all
                          fragments of a stage, which the host states: see fragments_per_pixel */
} pld_tier;

/* What the scene's materials need. A plane that no feature asks for is neither kept nor written. */
typedef PLD_ENUM(pld_feature){
    PLD_FEATURE_COLOURED = 1,   /* some material transmits colour; without it one opacity serves all channels */
    PLD_FEATURE_LIGHT = 2,      /* some material adds light: coverage 0, or transmission above .999 in a channel;
                                   without it such light is lost. Not in the published tier, which has no plane for
                                   it */
    PLD_FEATURE_REFRACTION = 4, /* clear glass, which lets more than .999 through, needs PLD_FEATURE_LIGHT besides */
    PLD_FEATURE_DIFFUSION = 8,
    PLD_FEATURE_DISPERSION = 16, /* refraction of its own for red and blue; not in the published tier */
    PLD_FEATURE_SOLIDS = 32,     /* some fragments hide everything: PLD_STAGE_SOLIDS is drawn before the layers */
    PLD_FEATURE_RIMS = 64, /* antialiased rims of cut-out leaves take their ambient occlusion from the opaque pixels
                              beside them: PLD_STAGE_RIMS is drawn after the layers. In the published tier and with
                              PLD_METHOD_FRONT_TAIL there is no such stage: the seam of the layers darkens each rim,
                              and reads a texture more */
    PLD_FEATURE_LOW_RESOLUTION =
        128 /* smoke and its like at a part of the resolution: PLD_STAGE_LOW is drawn last. Its
           layers do not hide everything. With PLD_METHOD_FRONT_TAIL what they are upsampled to lies over
           the nearest layer where it stands before it. Not in the published tier, which keeps no depths
           to upsample by, nor in the exact tier with PLD_METHOD_FRONT_TAIL, which keeps no nearest depth
           (`pellucid composite` refuses --low-res with --precision published and exact, and with
           --method front+tail, which it works out from all fragments) */
    ,
    PLD_FEATURE_OUTPUTS = 256 /* what later passes ask of the layers: PLD_VIEW_REACTIVE and PLD_VIEW_NEAREST_DEPTH, for
                                 which a plane keeps the depth of the nearest layer. Not in the published tier */
    ,
    PLD_FEATURE_DEPTHS = 512,   /* PLD_VIEW_MEAN_DEPTH and, in PLD_TIER_EXACT without PLD_FEATURE_LOW_RESOLUTION,
                                   PLD_VIEW_OPACITY_DEPTH, which only lists can tell. Takes the planes of
                                   PLD_FEATURE_OUTPUTS, in the exact tier another of 64 bits and a sort of each list.
                                   Not in the published tier, nor with PLD_METHOD_FRONT_TAIL and
                                   PLD_FEATURE_LOW_RESOLUTION together */
    PLD_FEATURE_MOTION = 1024,  /* PLD_VIEW_MOTION, from PldSurface.motion: a plane of 128 bits, with PLD_FEATURE_SOLIDS
                                   another. Not in the published tier. Where features fill all eight targets
                                   pld_create() says which may go; the exact tier has room for all */
    PLD_FEATURE_IDENTITY = 2048 /* PLD_VIEW_IDENTITY, from PldSurface.identity: in the plane of motion, or 32 bits of
                                   its own. PLD_STAGE_FRONT is drawn first, but in the exact tier. Not in the
                                   published tier */
} pld_feature;

/* Diagnostics, for pld_create_info.flags. */
typedef PLD_ENUM(pld_flag){
    PLD_FLAG_TIMERS = 2,       /* GPU times of every stage, see pld_query() */
    PLD_FLAG_DEBUG_GROUPS = 4, /* KHR_debug groups around every stage */
    PLD_FLAG_DEBUG_VIEWS = 8,  /* pld_target.view may ask for a plane instead of the picture */
    PLD_FLAG_TRUST_TEXTURES =
        32,                /* not a diagnostic either: the textures and targets of every frame are of the kinds
                              and formats, and at least of the sizes, of those of the first whole frame since
                              pld_resize(), which are looked at, and its context is current. The library then
                              asks GL nothing about them; with PLD_FLAG_HOST_RESTORES it asks GL nothing at all */
    PLD_FLAG_VALIDATE = 16 /* pld_end() and pld_shadow_end() look at what the host did since the begin, and say of
                              the first thing that is wrong what it is, with PLD_ERROR_MISUSE: the framebuffer,
                              viewport, blending, colour masks or depth test are others; the seam's textures and
                              buffers are; or, if anything was drawn, the program that is in use holds no text of
                              this pass, that of another stage or pass, or is not connected. It waits for the
                              device at every end, and counts GL_PRIMITIVES_GENERATED. Keep the last program in use
                              until the end; those of pipelines are not looked into */
} pld_flag;
/* Not a diagnostic but a contract, for pld_create_info.flags too: nothing is saved or put back, and the host sets all
   state of INTEGRATION.md itself. */
#define PLD_FLAG_HOST_RESTORES 1u

typedef PLD_ENUM(pld_weight){PLD_WEIGHT_BY_EQ5 = 0, /* McGuire and Mara 2017, eq. 5 */
                             PLD_WEIGHT_BY_EQ7 = 1, /* McGuire and Bavoil 2013, eqs. 7 to 10 as printed */
                             PLD_WEIGHT_BY_EQ8 = 2,   PLD_WEIGHT_BY_EQ9 = 3,  PLD_WEIGHT_BY_EQ10 = 4,
                             PLD_WEIGHT_BY_EQ7Z = 5, /* the same without their second factor of alpha */
                             PLD_WEIGHT_BY_EQ8Z = 6,  PLD_WEIGHT_BY_EQ9Z = 7, PLD_WEIGHT_BY_EQ10Z = 8,
                             PLD_WEIGHT_BY_POWER = 9, /* z over weight_reference to the power of -weight_exponent */
                             PLD_WEIGHT_BY_NONE = 10} pld_weight;

typedef PLD_ENUM(pld_depth){
    PLD_DEPTH_DEVICE = 0, /* a depth texture; it also tests the layers, by LEQUAL or, reversed, GEQUAL */
    PLD_DEPTH_REVERSED = 1,
    PLD_DEPTH_LINEAR =
        2 /* red of a float texture is planar view distance in scene units; 0 and less, or inf: nothing */
} pld_depth;

typedef PLD_ENUM(pld_clip){PLD_CLIP_MINUS_ONE_TO_ONE = 0, PLD_CLIP_ZERO_TO_ONE = 1} pld_clip; /* as glClipControl */
typedef PLD_ENUM(pld_rows){PLD_ROWS_UP = 0,
                           PLD_ROWS_DOWN = 1} pld_rows; /* texel row 0 is the picture's bottom, its top */

typedef struct pld_create_info {
  uint32_t struct_size; /* sizeof(pld_create_info) */
  uint32_t version;     /* PLD_VERSION */
  pld_get_proc_address get_proc_address;
  void* get_proc_address_user;
  pld_log log; /* may be null */
  void* log_user;
  pld_method method;
  pld_tier tier;
  uint32_t features; /* pld_feature, or-ed */
  uint32_t flags;    /* pld_flag and PLD_FLAG_HOST_RESTORES, or-ed */
  pld_weight weight;
  pld_depth depth;
  pld_clip clip;
  pld_rows rows;
  uint32_t uniform_binding;  /* binding point of the seam's uniform block, while stages are drawn */
  uint32_t texture_unit;     /* the seam reads this unit and the two after it, while stages are drawn; three after it
                                with PLD_FEATURE_RIMS in the published tier or with PLD_METHOD_FRONT_TAIL */
  float fragments_per_pixel; /* PLD_TIER_EXACT: room for this many on the average of pld_resize()'s picture, in each
                                stage; > 0, at most 65536. 36 bytes each, 52 with refraction, diffusion or (not under
                                PLD_METHOD_FRONT_TAIL) rims, 68 with dispersion; 16 more with motion or
                                identity. Where more come, pld_end() returns PLD_ERROR_MEMORY */
  uint32_t storage_binding;  /* PLD_TIER_EXACT: the first of three shader storage bindings, four with refraction,
                                diffusion or (not under PLD_METHOD_FRONT_TAIL) rims, five with dispersion, that the seam
                                writes to while stages are drawn; one more with motion or identity. 0.3 ended before
                                fragments_per_pixel */
  char* message;             /* null, or room for message_size bytes: where pld_create() says why it fails, since there
                                is no pass yet that pld_message() could be asked of; "" where it does not */
  size_t message_size;       /* 0.4 ended before message */
} pld_create_info;

typedef PLD_ENUM(pld_refract){
    PLD_REFRACT_NOTHING = 0,
    PLD_REFRACT_AT_DISTANCE = 1, /* the background lies refract_distance behind every surface */
    PLD_REFRACT_AT_DEPTH = 2,    /* it lies at the opaque depth */
    PLD_REFRACT_THROUGH_SLAB = 3 /* over the surface's thickness, then straight on */
} pld_refract;

typedef PLD_ENUM(pld_occlusion){
    PLD_OCCLUSION_RELATIVE = 0, /* depths compared relative to the rim's, open where nothing opaque is near */
    PLD_OCCLUSION_PUBLISHED = 1 /* McGuire and Mara 2017, listing 2 as printed */
} pld_occlusion;

/* Numbers that a pass does not read - refract_distance but of PLD_REFRACT_AT_DISTANCE, diffusion_k0 and _k1 without
   PLD_FEATURE_DIFFUSION, weight_exponent and weight_reference of weights that read none - may have any value, 0
   too, but NaN and infinity. */
typedef struct pld_frame {
  uint32_t struct_size;    /* sizeof(pld_frame) */
  uint32_t colour_texture; /* lit opaque picture, scene-linear, premultiplied; read by pld_resolve() */
  uint32_t depth_texture;
  int32_t width, height; /* the picture is texels (0, 0) to (width, height) of every texture; at most pld_resize()'s */
  float projection[16];  /* clip from view, by columns; right-handed, the eye looks down -z; jitter is in it */
  float metres_per_unit; /* of view space, > 0 */
  float pre_exposure;    /* what colour_texture carries already; the seam multiplies radiance by it; > 0 */
  float weight_near,
      weight_far;        /* metres, 0 < near < far: range of eqs. 5 and 10, from the camera, not from the frame */
  float weight_exponent; /* of PLD_WEIGHT_BY_POWER; the number behind the name of others that take one */
  pld_refract refract;
  float refract_distance;     /* metres, > 0; PLD_REFRACT_AT_DISTANCE */
  float diffusion_k0;         /* metres, >= 0; 0.3 as in the papers' pictures */
  float diffusion_k1;         /* metres, > 0; 0.5 */
  uint32_t occlusion_texture; /* PLD_FEATURE_RIMS: red is the ambient occlusion of what is opaque, and of solids, [0,1],
                                 1 open */
  pld_occlusion occlusion;
  int32_t low_factor; /* PLD_FEATURE_LOW_RESOLUTION: 2, 4 or 8 pixels a texel; width and height are multiples of it */
  float weight_reference; /* metres, >= 0. PLD_WEIGHT_BY_POWER: where a layer weighs 1; take a distance at which the
                             scene's transparent things begin, from camera and scene, not from the frame. The picture
                             is the same for any, as long as weights stay in 2^-86 to 2^40 (in halves 2^-24 to 2^16):
                             a power then is the same picture in any unit. Eqs. 7 to 9: the unit of their constants. 0:
                             1 m, as hosts of before have it. 0.5 ended before weight_reference */
  float depth_opacity;    /* 0 to 1. PLD_VIEW_OPACITY_DEPTH: how much is hidden where that depth is; 0.5. 0.13 ended
                             before depth_opacity */
} pld_frame;

/* Fields of pld_frame that no frame changes. */
typedef PLD_ENUM(pld_fixed){
    PLD_FIXED_UNITS = 1,       /* metres_per_unit */
    PLD_FIXED_EXPOSURE = 2,    /* pre_exposure */
    PLD_FIXED_WEIGHT = 4,      /* weight_near, weight_far, weight_exponent, weight_reference */
    PLD_FIXED_REFRACTION = 8,  /* refract, refract_distance */
    PLD_FIXED_DIFFUSION = 16,  /* diffusion_k0, diffusion_k1 */
    PLD_FIXED_PROJECTION = 32, /* whether projection is perspective or orthographic; its numbers may change */
    PLD_FIXED_LENS = 64 /* projection[0] * width and projection[5] * height but for their signs, and metres_per_unit
                           where projection is orthographic */
} pld_fixed;

typedef PLD_ENUM(pld_stage){
    PLD_STAGE_SOLIDS = 0, /* with PLD_FEATURE_SOLIDS: the same geometry, the nearest fragment that hides everything */
    PLD_STAGE_FRONT = 1,  /* with PLD_METHOD_FRONT_TAIL or PLD_FEATURE_IDENTITY: the same geometry, its nearest depth;
                             not in the exact tier */
    PLD_STAGE_LAYERS = 2, /* all transparent geometry, in any order */
    PLD_STAGE_RIMS = 3,   /* with PLD_FEATURE_RIMS, but for the published tier and PLD_METHOD_FRONT_TAIL: the cut-out
                             geometry of   the layers, by pldWriteRim() */
    PLD_STAGE_LOW = 4,    /* with PLD_FEATURE_LOW_RESOLUTION: geometry of its own, on width and height over low_factor;
                             pld_end() upsamples what it leaves, as one layer of every pixel */
    PLD_STAGE_CASTERS = 5 /* of recipes of shadow maps alone, where pld_shadow_begin() serves a pass: what casts, as one
                             face of a light sees it, by pldWriteCaster() */
} pld_stage;

typedef PLD_ENUM(pld_view){
    PLD_VIEW_PICTURE = 0, PLD_VIEW_LAYER_COUNT = 1, /* grey: layers / 16; published: 1 where any */
    PLD_VIEW_MEAN_COLOUR = 2,                       /* the layers' weighted mean */
    PLD_VIEW_TRANSMISSION = 3,                      /* beta */
    PLD_VIEW_WEIGHT = 4, /* mean weight of the occluders, per channel, over 1 + itself; without
                            PLD_FEATURE_LIGHT and _LOW_RESOLUTION the sum of weight times opacity, over 1 + itself */
    PLD_VIEW_LIGHT = 5,  /* light that adds */
    PLD_VIEW_OFFSET = 6, /* red, green: 0.5 + offset / 128 px; blue: 1 where anything refracts */
    PLD_VIEW_SPREAD = 7, /* D / 64 px */
    PLD_VIEW_CLAMPED =
        8,              /* 1 where a sum is as large as its format goes: red colour or weight, green spread or offset */
    PLD_VIEW_SOLID = 9, /* colour of the nearest solid */
    /* With PLD_STAGE_RIMS: */
    PLD_VIEW_RIM_OCCLUSION = 10, /* red: what the opaque pixels beside a rim hide of the light from around; green: the
                                    rest, 1 - red; black where no rim is */
    PLD_VIEW_RIM_LOSS =
        11, /* what rims have taken from the layers' light, premultiplied, as the picture would hold it */
    /* With PLD_FEATURE_LOW_RESOLUTION, a square of low_factor pixels for each texel, as before upsampling: */
    PLD_VIEW_LOW_COLOUR = 12,       /* light of a texel's layers, premultiplied */
    PLD_VIEW_LOW_TRANSMISSION = 13, /* beta of a texel */
    PLD_VIEW_LOW_DEPTH = 14, /* planar depths z, as z / (z + 1 m): red mean of the layers, green nearest of them, blue
                                farthest opaque depth, which they were tested against; black where no layer is */
    /* Of shadow maps, between frames or after any stage: texel (x, y) of face pld_target.shadow_face as it is looked
       up, at pixel (x, y); as many pixels as the face has, pld_shadow_info.size or, of forms 0 and 1, a quarter of it,
       either way. */
    PLD_VIEW_SHADOW_TRANSMISSION = 15, /* what all of a texel's casters leave of the light */
    PLD_VIEW_SHADOW_COINS = 16,        /* in what part of a texel's samples coins have left a caster, per channel */
    PLD_VIEW_SHADOW_DEPTH = 17, /* their mean depth, 0 at near_depth (of local lights, at the light), 1 at far_depth */
    /* With PLD_FEATURE_OUTPUTS, and without PLD_FLAG_DEBUG_VIEWS: */
    PLD_VIEW_REACTIVE =
        18, /* 1 - beta, the mean of its channels: what part of a pixel is not the opaque picture's, as
               temporal antialiasing and upscalers ask. Light that adds and hides nothing is not in it */
    PLD_VIEW_NEAREST_DEPTH = 19, /* planar metres of the nearest layer, +inf where none is */
    /* Likewise, with PLD_FEATURE_DEPTHS. Solids are layers of opacity 1. */
    PLD_VIEW_MEAN_DEPTH = 20, /* planar metres: the mean of the layers, each by its opacity (the mean over the channels
                                 to which it does not add light). Where all only add light, of the nearest; +inf
                                 where none is. With PLD_METHOD_FRONT_TAIL, but in the exact tier, layers in one plane
                                 with the nearest count as one, over all channels */
    PLD_VIEW_OPACITY_DEPTH = 21, /* planar metres of the first layer from the eye with which all so far hide
                                    pld_frame.depth_opacity of what is behind them, the mean of the channels; +inf
                                    where all together do not. PLD_TIER_EXACT alone */
    /* Likewise, with PLD_FEATURE_MOTION: */
    PLD_VIEW_MOTION = 22, /* red, green: the mean of the layers' PldSurface.motion, each by its opacity as above: pixels
                             of the frame, from where a point is seen to where it was seen in the last frame, x to the
                             right and y down whatever pld_rows says; 0 where no layer hides anything. Alpha: 1 - beta,
                             by which it may be laid over the opaque picture's motion. What is drawn in PLD_STAGE_LOW
                             has none */
    /* Likewise, with PLD_FEATURE_IDENTITY: */
    PLD_VIEW_IDENTITY = 23 /* red: PldSurface.identity of the nearest layer, of several there the smallest; 0 where none
                              is, or none was given. Whole numbers: a target of 32-bit floats keeps all of them. What is
                              drawn in PLD_STAGE_LOW has none and hides none */
} pld_view;

typedef PLD_ENUM(pld_target_kind){PLD_TARGET_TEXTURE = 0, PLD_TARGET_FRAMEBUFFER = 1} pld_target_kind;

typedef struct pld_target {
  uint32_t struct_size; /* sizeof(pld_target) */
  pld_target_kind kind;
  uint32_t name; /* of a texture other than the frame's, or of a framebuffer whose first draw buffer is drawn to */
  pld_view view;
  int32_t shadow_face; /* of PLD_VIEW_SHADOW_*: 0 to pld_shadow_info.faces - 1, one that has been drawn. Not in 0.3 */
} pld_target;

typedef PLD_ENUM(pld_value){
    PLD_VALUE_BITS_PER_PIXEL = 0, /* of the planes that layers are blended into */
    PLD_VALUE_BYTES = 1,          /* of all textures and lists of this pass, since pld_resize() */
    PLD_VALUE_PLANES = 2,         /* how many textures layers are blended into */
    PLD_VALUE_GEOMETRY_PASSES = 3,
    PLD_VALUE_FIRST_PLANE = 4, /* + i: the GL name of plane i, to look at; 0 where draw buffer i is not used; i < 8 */
    PLD_VALUE_NS_BEGIN = 16,   /* nanoseconds on the device, of the newest frame that is known; PLD_FLAG_TIMERS */
    PLD_VALUE_NS_DRAWS = 17,   /* from the end of pld_begin() to that of pld_end(), all stages */
    PLD_VALUE_NS_RESOLVE = 18,
    PLD_VALUE_NS_SHADOW =
        19, /* of the newest face that is known, from pld_shadow_begin() to pld_shadow_end(), draws included */
    PLD_VALUE_FRAGMENTS =
        20, /* PLD_TIER_EXACT: what came in the fullest stage of the newest frame, with or without room */
    PLD_VALUE_FRAGMENT_ROOM = 21,  /* PLD_TIER_EXACT: what fits, since pld_resize() */
    PLD_VALUE_SHADOW_TEXTURE = 24, /* GL names, 0 before pld_shadow_resize(): the GL_TEXTURE_2D_ARRAY of the maps */
    PLD_VALUE_SHADOW_BUFFER = 25,  /* the uniform buffer of their table */
    PLD_VALUE_SHADOW_BYTES = 26    /* of all textures of the maps */
} pld_value;

/* Shadows of transparent things: a coloured stochastic shadow map for every light, McGuire and Mara 2017 section 5. */
typedef PLD_ENUM(pld_shadow_form){
    PLD_SHADOW_VARIANCE =
        0, /* prefiltered, a quarter of the size is kept; exact in what hides: no noise on opaque receivers */
    PLD_SHADOW_PUBLISHED = 1,  /* prefiltered as the paper has it: a coin a texel */
    PLD_SHADOW_NAIVE = 2,      /* Enderton et al. 2010: squares of texels, each before or behind; a coin a texel */
    PLD_SHADOW_STRATIFIED = 3, /* coins stratified over squares of texels */
    PLD_SHADOW_CORRECTED = 4   /* and scaled to what exactly hides */
} pld_shadow_form;

typedef struct pld_shadow_info {
  uint32_t struct_size; /* sizeof(pld_shadow_info) */
  pld_shadow_form form;
  int32_t size;        /* texels along an edge as drawn, 16 to 16384, a multiple of 4 */
  int32_t lights;      /* 1 to 16: pldShadow() knows them as 0 to lights - 1 */
  int32_t faces;       /* 1 to 96, of all lights together: a sun or a spot takes one, a point light six */
  int32_t coloured;    /* 0: no caster transmits colour, and one channel serves all */
  int32_t closer_edge; /* 1 to 16 texels, of the square that the forms 2 to 4 compare; 4 */
  uint32_t seed;
  uint32_t uniform_binding; /* where the host binds PLD_VALUE_SHADOW_BUFFER and _TEXTURE, or those of a recipe, while it
                               draws with */
  uint32_t texture_unit;    /* pldShadow(): other places than those of pld_create_info, of pld_recipe_info */
} pld_shadow_info;

typedef PLD_ENUM(pld_light){
    PLD_LIGHT_DIRECTIONAL = 0, PLD_LIGHT_LOCAL = 1 /* a spot or a point, at the origin of its view space */
} pld_light;

/* One face of one light, as it looks at its casters. */
typedef struct pld_shadow_view {
  uint32_t struct_size; /* sizeof(pld_shadow_view) */
  pld_light kind;
  int32_t light;               /* 0 to pld_shadow_info.lights - 1 */
  int32_t first_face, faces;   /* the light's of pld_shadow_info.faces; faces is 1 or, for a local light, 6 */
  int32_t face;                /* the one that is drawn, 0 to faces - 1; all are drawn before the light is looked up */
  float light_from_scene[16];  /* by columns, turns and shifts alone: from the space in which pldShadow() is asked, the
                                  camera's view or the world, to this face's view space, which looks down -z */
  float projection[16];        /* clip from that view space: orthographic or, local, perspective with w = -z. Of six
                                  faces all are square and a little wider than 90 degrees; a face owns its 90 */
  float near_depth, far_depth; /* where casters lie, scene units, near < far: along -z, of a local light far_depth is
                                  the greatest distance and near_depth is not used. The origin of a sun's view may lie
                                  anywhere, among its casters too: near_depth is negative then */
  uint32_t depth_texture;      /* 0, or what is opaque as this view sees it, depth of size x size: casters behind it, by
                                  LEQUAL or, with PLD_DEPTH_REVERSED, GEQUAL, are left out */
} pld_shadow_view;

typedef PLD_ENUM(pld_shadow_text){
    PLD_SHADOW_TEXT_CASTER =
        0,                     /* pldWriteCaster(), for what is drawn between pld_shadow_begin() and pld_shadow_end() */
    PLD_SHADOW_TEXT_LOOKUP = 1 /* pldShadow() and pldShadowOnOpaque(), for the light pass and for layers */
} pld_shadow_text;

/* The version of the library, as PLD_VERSION. */
PLD_API uint32_t pld_version(void);
/* The weight of a name that `pellucid composite --weight` takes, its parameter left out: "eq7z", "power". Weights that
   have come after this header have a value, and no constant. PLD_ERROR_ARGUMENT for a name that is none. */
PLD_API pld_status pld_weight_named(const char* name, pld_weight* weight);

/* Order of calls: create, fix if wanted, resize, then frames of { begin, draws, end } for every stage, solids, front,
   layers, rims, low, and resolve. resize and destroy lie between frames. A frame may be given up: pld_end(), then begin
   its first stage again. Where pld_create() fails *pass is null, and info.log and info.message say why. */
PLD_API pld_status pld_create(const pld_create_info* info, pld_pass** pass);
/* Before pld_glsl(): what `fields` (pld_fixed, or-ed) names of every frame is as in this one, of which nothing else is
   read. The texts hold it as constants, which costs less than reading it; pld_begin() refuses a frame that has another.
 */
PLD_API pld_status pld_fix(pld_pass* pass, const pld_frame* frame, uint32_t fields);
/* Room for pictures up to width x height. Gives back what the last size took. */
PLD_API pld_status pld_resize(pld_pass* pass, int32_t width, int32_t height);
/* Binds a framebuffer of this library and sets blending, masks, depth and viewport; the host then draws with programs
   that hold the seam of this stage. In between it may change anything but those. */
PLD_API pld_status pld_begin(pld_pass* pass, pld_stage stage, const pld_frame* frame);
/* Puts back the state that pld_begin() found. In PLD_TIER_EXACT it waits for the device, to learn whether all fragments
   had room. If not, it returns PLD_ERROR_MEMORY and the stage counts as not drawn, so pld_resolve() refuses the frame:
   begin the stage again with less geometry, or make another pass with the room that PLD_VALUE_FRAGMENTS tells. */
PLD_API pld_status pld_end(pld_pass* pass);
/* The picture, or a view of a plane, into the target. Pixels without layers get the background's bits. Views of shadow
   maps need no frame. */
PLD_API pld_status pld_resolve(pld_pass* pass, const pld_target* target);
PLD_API pld_status pld_query(pld_pass* pass, pld_value what, uint64_t* value);
/* Sets *pass to null. With no context current nothing on the device is given back. */
PLD_API pld_status pld_destroy(pld_pass** pass);

/* The GLSL that a material's fragment shader holds for a stage, after its #version line: pldWriteFragment() and the
   outputs. For GLSL `version` 330 to 460, in PLD_TIER_EXACT from 430. The text is the pass's and lives until it is
   asked for again or destroyed. It declares

     struct PldSurface {     one shaded transparent surface under this fragment
       vec3 radiance;        coverage * reflected + emitted, premultiplied, scene-linear, >= 0
       float coverage;       part of the pixel it touches, [0,1]; 0 for light that adds and hides nothing
       vec3 transmission;    colour let straight through where it touches, at the actual angle, [0,1]
       vec3 position;        view space, scene units; the eye looks down -z, and z >= 0 is discarded
     with refraction or diffusion, and filled in by pldSurface():
       vec3 normal;          view space, unit, on the side of the eye
       float eta;            index outside over inside, of green, > 0; 1 bends nothing. Only front faces refract
       vec2 etaRedBlue;      of red and blue, with dispersion; a component that is not > 0 is as eta
       float thickness;      scene units, along the normal, >= 0; for PLD_REFRACT_THROUGH_SLAB
       float collimation;    [0,1]: 1 clear, 0 scatters all
     with PLD_FEATURE_MOTION or _IDENTITY, where the text defines PLD_MARKS, and set to 0 by pldSurface():
       vec2 motion;          pixels of the frame, y down: where the point was seen in the last frame less where it
                             is seen now, both without jitter. As FSR 2, DLSS and XeSS take it
       uint identity;        of the object, at most 16777215; 0 for none
     };
     PldSurface pldSurface(vec3 radiance, float coverage, vec3 transmission, vec3 position);
         a surface that neither refracts nor diffuses: eta 1, etaRedBlue 0, thickness 0, collimation 1
     void pldWriteFragment(PldSurface surface);
         where a colour was written, at one place of the shader: each call is inlined whole. It may discard
     void pldWriteLayer(vec3 radiance, float coverage, vec3 transmission, float z, vec2 offset,
                        float variance, vec4 dispersion);
         the same, for hosts that know what scattering does: radiance with its exposure, z planar metres,
         offset in pixels with y down, variance in pixels^2, dispersion: the offsets of red and of blue
         less `offset`
     void pldMark(vec2 motion, uint identity);
         with PLD_FEATURE_MOTION or _IDENTITY, before pldWriteLayer(): what PldSurface has of these

   and with PLD_FEATURE_RIMS

     vec2 pldCoverageGradient(float coverage);
         its change per pixel in x and y: where control flow is uniform, before any discard
     void pldWriteRim(PldSurface surface, vec3 around, vec2 gradient);
         in place of pldWriteFragment() for cut-out surfaces; around: the part of surface.radiance that
         ambient occlusion darkens; gradient: pldCoverageGradient()

   What is out of its range is clamped; NaN is not looked for. */
PLD_API pld_status pld_glsl(pld_pass* pass, pld_stage stage, int32_t version, const char** text);
/* Connects the uniform blocks and samplers of all texts that a linked program holds; refuses one that holds none.
   Needed once per program below GLSL 4.20; of PLD_SHADOW_TEXT_LOOKUP after pld_shadow_resize(). */
PLD_API pld_status pld_connect(pld_pass* pass, uint32_t program);

/* Room for shadow maps; null gives it back. The same info again keeps the maps; any other loses them. */
PLD_API pld_status pld_shadow_resize(pld_pass* pass, const pld_shadow_info* info);
/* As pld_begin() and pld_end(), for the casters of one face, in any order; outside of stages. Casters are
   drawn with the clip origin that GL has at pld_shadow_begin(). */
PLD_API pld_status pld_shadow_begin(pld_pass* pass, const pld_shadow_view* view);
/* Filters the face, and puts back the state that pld_shadow_begin() found. */
PLD_API pld_status pld_shadow_end(pld_pass* pass);
/* As pld_glsl(). The texts fit the info of the last pld_shadow_resize(), and no other. That of casters declares

     struct PldCaster {      one transparent surface as its light sees it
       float coverage;       part of the texel it touches, [0,1]; 0 casts nothing
       vec3 transmission;    colour let straight through where it touches, at the light's angle, [0,1]
       vec3 position;        the light's view space, scene units; z < 0 of local lights, any z of a sun's
       vec3 normal;          there, unit, on either side
       float eta;            index outside over inside: below 1 it makes a caustic; not > 0 is as 1
       uint identity;        of the triangle, the same every frame: pldCasterIdentity()
     };
     uint pldCasterIdentity(uint instance, uint triangle);
         instance: a number for the object; triangle: within it, gl_PrimitiveID
     void pldWriteCaster(PldCaster caster);
         it may discard

   and that of lookups, whose `light` is pld_shadow_view.light and whose `point` lies in the space that
   light_from_scene starts from,

     vec3 pldShadow(int light, vec3 point);
         RGB part of the light that transparent casters leave, [0,1], 1 where no map reaches: in the air or
         on a transparent surface
     vec3 pldShadowOnOpaque(int light, vec3 point);
         the same on an opaque surface, which every caster that its texel knows stands before */
PLD_API pld_status pld_shadow_glsl(pld_pass* pass, pld_shadow_text which, int32_t version, const char** text);

/* What the last call that failed on this pass said: one sentence; "" when none did. Lives until the next call. */
PLD_API const char* pld_message(const pld_pass* pass);
/* "PLD_ERROR_ORDER" and the like. */
PLD_API const char* pld_status_name(pld_status status);

/* Structs with their size and version, and with what most hosts say: nothing is 0 that may not be. A host fills in the
   rest. */
static inline pld_create_info pld_create_info_init(void) {
  pld_create_info info;
  memset(&info, 0, sizeof(info));
  info.struct_size = sizeof(info);
  info.version = PLD_VERSION;
  return info; /* get_proc_address, and in PLD_TIER_EXACT fragments_per_pixel, are the host's to say */
}
static inline pld_frame pld_frame_init(void) {
  pld_frame frame;
  memset(&frame, 0, sizeof(frame));
  frame.struct_size = sizeof(frame);
  frame.metres_per_unit = frame.pre_exposure = frame.weight_reference = 1.0f;
  frame.weight_near = 0.1f;
  frame.weight_far = 1000.0f;
  frame.weight_exponent = 3.0f;
  frame.refract_distance = 1.0f;
  frame.diffusion_k0 = 0.3f;
  frame.diffusion_k1 = 0.5f;
  frame.low_factor = 2;
  frame.depth_opacity = 0.5f;
  return frame; /* textures, size and projection are the host's to say */
}
static inline pld_target pld_target_init(pld_target_kind kind, uint32_t name) {
  pld_target target;
  memset(&target, 0, sizeof(target));
  target.struct_size = sizeof(target);
  target.kind = kind;
  target.name = name;
  return target;
}
static inline pld_shadow_info pld_shadow_info_init(int32_t size, int32_t lights, int32_t faces) {
  pld_shadow_info info;
  memset(&info, 0, sizeof(info));
  info.struct_size = sizeof(info);
  info.size = size;
  info.lights = lights;
  info.faces = faces;
  info.coloured = 1;
  info.closer_edge = 4;
  return info;
}
static inline pld_shadow_view pld_shadow_view_init(pld_light kind) {
  pld_shadow_view view;
  memset(&view, 0, sizeof(view));
  view.struct_size = sizeof(view);
  view.kind = kind;
  view.faces = 1;
  return view;
}

#ifdef __cplusplus
}
#endif
#endif
