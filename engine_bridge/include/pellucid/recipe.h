/* What Pellucid does in a frame, as data: images, passes in their order, and the GLSL of each. An engine that is not
   OpenGL, or that wants every pass in a graph of its own, makes the images, runs the passes and draws its transparent
   geometry where a pass says so; the pass of pellucid.h draws by the same tables. See INTEGRATION.md, "Vulkan".

   A recipe needs no device and no context. It is made by pld_recipe_create() and never changes: any thread may read it
   while others do. What its functions return lives until pld_recipe_destroy(). None of the structs that it hands out
   grows; what is new comes by new functions. Since 0.9.

   A frame
     1. Once: make every image that is the recipe's own, by pld_recipe_image_size(), and every buffer, by
        pld_recipe_buffer_size(). Pipelines: see pld_recipe_pass.
     2. Every frame, for every pass in order and each of its pld_recipe_repeats(): ask pld_recipe_fill() for the area
        and the constants, make what is read visible, clear or load the attachments, draw. The passes of the kind
        PLD_PASS_DRAWS are the host's own draws, with shaders that hold the pass's text; the others draw one triangle of
        three vertices without any input.
     3. The image of PLD_ROLE_PICTURE is the picture. The passes that write those of PLD_ROLE_REACTIVE and after may be
        left out, and run again.
   No pass reads an image that it writes.

   Shadow maps of transparent casters have a recipe of their own, whose passes draw one face of one light: see
   pld_shadow_recipe_create(). Since 0.14. */
#ifndef PELLUCID_RECIPE_H
#define PELLUCID_RECIPE_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pld_recipe pld_recipe;

typedef PLD_ENUM(pld_dialect){
    PLD_DIALECT_GL = 0,    /* GLSL 330 to 460, core; PLD_TIER_EXACT from 430 */
    PLD_DIALECT_ES = 1,    /* GLSL ES 320; not PLD_TIER_EXACT, which sums in double precision */
    PLD_DIALECT_VULKAN = 2 /* GLSL 450 and 460 as GL_KHR_vulkan_glsl has it: every binding is explicit */
} pld_dialect;

typedef struct pld_recipe_info {
  uint32_t struct_size; /* sizeof(pld_recipe_info) */
  uint32_t version;     /* PLD_VERSION */
  pld_method method;    /* these as in pld_create_info */
  pld_tier tier;
  uint32_t features;
  pld_weight weight;
  pld_depth depth;
  pld_clip clip; /* of Vulkan PLD_CLIP_ZERO_TO_ONE */
  pld_rows rows; /* PLD_ROWS_DOWN where texel row 0 is the top of the picture, as Vulkan's hosts mostly have it */
  pld_dialect dialect;
  int32_t glsl;             /* version of the texts, as their #version lines have it */
  uint32_t set;             /* Vulkan: the descriptor set of what the texts for the host's draws declare; that of
                               full-screen passes, whose pipelines are all Pellucid's, is 0 */
  uint32_t uniform_binding; /* where the texts for the host's draws find their block, */
  uint32_t texture_binding; /* the first of their three textures (four where the seam darkens rims), */
  uint32_t storage_binding; /* and in PLD_TIER_EXACT the first of three to six storage blocks. In Vulkan all of them
                               are bindings of one set, and differ */
  uint32_t fixed_fields;    /* pld_fixed, or-ed: what `fixed` says of every frame stands in the texts as constants */
  const pld_frame* fixed;   /* null where fixed_fields is 0 */
  char* message;            /* null, or room for message_size bytes: why pld_recipe_create() fails, in a sentence */
  size_t message_size;
} pld_recipe_info;

typedef PLD_ENUM(pld_format){PLD_FORMAT_HOST = 0, /* of an image that is the host's */
                             PLD_FORMAT_R16F = 1,  PLD_FORMAT_RG16F = 2,     PLD_FORMAT_RGBA16F = 3,
                             PLD_FORMAT_R32F = 4,  PLD_FORMAT_RG32F = 5,     PLD_FORMAT_RGBA32F = 6,
                             PLD_FORMAT_RGBA8 = 7, PLD_FORMAT_RG8_SNORM = 8, PLD_FORMAT_DEPTH32F = 9} pld_format;

typedef PLD_ENUM(pld_role){
    PLD_ROLE_OWN = 0,           /* made for the recipe */
    PLD_ROLE_COLOUR = 1,        /* the host's: the lit opaque picture, as pld_frame.colour_texture */
    PLD_ROLE_DEPTH = 2,         /* as pld_frame.depth_texture; tested against and read, never written */
    PLD_ROLE_OCCLUSION = 3,     /* as pld_frame.occlusion_texture */
    PLD_ROLE_PICTURE = 4,       /* the host's, written: the picture, another image than PLD_ROLE_COLOUR */
    PLD_ROLE_REACTIVE = 5,      /* PLD_FEATURE_OUTPUTS: red is what PLD_VIEW_REACTIVE shows */
    PLD_ROLE_NEAREST_DEPTH = 6, /* PLD_FEATURE_OUTPUTS: red is what PLD_VIEW_NEAREST_DEPTH shows */
    PLD_ROLE_MEAN_DEPTH = 7,    /* PLD_FEATURE_DEPTHS: red is what PLD_VIEW_MEAN_DEPTH shows */
    PLD_ROLE_OPACITY_DEPTH = 8, /* PLD_FEATURE_DEPTHS in PLD_TIER_EXACT: red is what PLD_VIEW_OPACITY_DEPTH shows */
    PLD_ROLE_MOTION = 9,        /* PLD_FEATURE_MOTION: red, green and alpha are what PLD_VIEW_MOTION shows */
    PLD_ROLE_IDENTITY = 10,     /* PLD_FEATURE_IDENTITY: red is what PLD_VIEW_IDENTITY shows */
    /* Of recipes of shadow maps: */
    PLD_ROLE_SHADOW_MAPS = 11, /* the maps of all faces: an array, of one layer too, that keeps what a face was drawn to
                                  until it is drawn again, and that lookups read. Its memory serves nothing else */
    PLD_ROLE_SHADOW_DEPTH = 12 /* as pld_shadow_view.depth_texture; tested against, never written. A face without one is
                                  drawn without the test */
} pld_role;

typedef PLD_ENUM(pld_usage){PLD_USAGE_READ = 1, PLD_USAGE_COLOUR = 2, PLD_USAGE_DEPTH = 4} pld_usage;

typedef struct pld_recipe_image {
  const char* name;
  pld_role role;
  pld_format format;
  uint32_t layers;                /* of an array; 1 for most */
  uint32_t usage;                 /* pld_usage, or-ed */
  uint32_t first_pass, last_pass; /* that use it: outside of them its memory may serve others */
  float clear[4];                 /* where an attachment's load is PLD_LOAD_CLEAR */
} pld_recipe_image;

typedef struct pld_recipe_buffer {
  const char* name;
} pld_recipe_buffer;

#define PLD_NO_IMAGE 0xffffffffu

/* Of `layer`, besides the number of one. */
#define PLD_LAYERS_ALL (-1)      /* read as an array */
#define PLD_LAYER_OF_REPEAT (-2) /* repeat modulo layers */
#define PLD_LAYER_BEFORE                                                                                               \
  (-3)                         /* repeat + 1 modulo layers: of two, what the last repeat wrote. In repeat 0 nothing is \
                                  looked up there */
#define PLD_LAYER_OF_FACE (-4) /* of shadow maps: that of pld_shadow_recipe_fill(), plus the attachment's location */

typedef PLD_ENUM(pld_load){PLD_LOAD_KEEP = 0, PLD_LOAD_CLEAR = 1,
                           PLD_LOAD_ANY = 2 /* all of the area is written */} pld_load;
typedef PLD_ENUM(pld_factor){PLD_FACTOR_ZERO = 0, PLD_FACTOR_ONE = 1,
                             PLD_FACTOR_ONE_MINUS_SOURCE_COLOUR = 2} pld_factor;
typedef PLD_ENUM(pld_blend_op){PLD_BLEND_ADD = 0, PLD_BLEND_MINIMUM = 1,
                               PLD_BLEND_TAKE = 2 /* destination - source: GL_FUNC_REVERSE_SUBTRACT */} pld_blend_op;

typedef struct pld_blend {
  int32_t enabled; /* 0: what is written stays as it is, and the others are not read */
  pld_factor source, destination;
  pld_blend_op op;
  pld_factor alpha_source, alpha_destination;
  pld_blend_op alpha_op;
} pld_blend;

typedef struct pld_recipe_attachment {
  uint32_t image;
  uint32_t location; /* of the output. Some are left out between others */
  int32_t layer;
  pld_load load;
  uint32_t write_mask; /* 1 red, 2 green, 4 blue, 8 alpha, or-ed */
  pld_blend blend;
} pld_recipe_attachment;

typedef struct pld_recipe_read {
  uint32_t image;
  uint32_t binding;
  int32_t layer;
  const char* sampler; /* its name in the text. All are read by nearest texel, clamped to the edge */
} pld_recipe_read;

typedef struct pld_recipe_storage {
  uint32_t buffer;
  uint32_t binding; /* as large as the buffer: the text asks for its length */
  int32_t empties;  /* not 0: before the pass the first pld_recipe_buffer_size() `zeroed` bytes are set to 0 */
  const char* block;
} pld_recipe_storage;

typedef PLD_ENUM(pld_pass_kind){PLD_PASS_DRAWS = 0, PLD_PASS_FULL_SCREEN = 1} pld_pass_kind;
typedef PLD_ENUM(pld_compare){PLD_COMPARE_NONE = 0, PLD_COMPARE_LESS_OR_EQUAL = 1, PLD_COMPARE_GREATER_OR_EQUAL = 2,
                              PLD_COMPARE_GREATER = 3} pld_compare;

typedef struct pld_recipe_pass {
  const char* name;
  pld_pass_kind kind;
  pld_stage stage; /* of PLD_PASS_DRAWS: which of the host's geometry */
  const pld_recipe_attachment* attachments;
  uint32_t attachment_count;
  const pld_recipe_read* reads;
  uint32_t read_count;
  const pld_recipe_storage* storage;
  uint32_t storage_count;
  uint32_t depth_image; /* PLD_NO_IMAGE, or tested against by depth_compare */
  pld_compare depth_compare;
  int32_t depth_write; /* not 0: cleared to depth_clear first, and written */
  float depth_clear;
  uint32_t set;               /* Vulkan: of the bindings of this pass */
  uint32_t constants_binding; /* of a uniform block in std140, */
  uint32_t constants_size;    /* of so many bytes; 0 for none */
  const char* constants_block;
  const char* vertex;   /* of PLD_PASS_FULL_SCREEN: a whole shader */
  const char* fragment; /* likewise; of PLD_PASS_DRAWS what the host's fragment shader holds after its #version line,
                           with pldWriteFragment() and the rest that stands beside pld_glsl() */
  uint64_t hash;        /* of both texts: the same in every process and version whose texts are the same */
} pld_recipe_pass;

/* PLD_ERROR_UNSUPPORTED for what pld_create() refuses too, and for a dialect without what the tier needs. */
PLD_API pld_status pld_recipe_create(const pld_recipe_info* info, pld_recipe** recipe);
/* Sets *recipe to null. */
PLD_API pld_status pld_recipe_destroy(pld_recipe** recipe);

PLD_API uint32_t pld_recipe_image_count(const pld_recipe* recipe);
PLD_API uint32_t pld_recipe_buffer_count(const pld_recipe* recipe);
PLD_API uint32_t pld_recipe_pass_count(const pld_recipe* recipe);
/* Null beyond the count. */
PLD_API const pld_recipe_image* pld_recipe_image_at(const pld_recipe* recipe, uint32_t index);
PLD_API const pld_recipe_buffer* pld_recipe_buffer_at(const pld_recipe* recipe, uint32_t index);
PLD_API const pld_recipe_pass* pld_recipe_pass_at(const pld_recipe* recipe, uint32_t index);

/* For pictures up to width x height, both 1 to 65536. The host's own images have at least these sizes. Those of shadow
   maps have one size, for which width and height are not looked at. */
PLD_API pld_status pld_recipe_image_size(const pld_recipe* recipe, uint32_t image, int32_t width, int32_t height,
                                         int32_t size[2]);
/* With room for `fragments` in every stage: pixels times as many as they have on the average.
     zeroed  how much of its beginning a pass empties, where it does */
PLD_API pld_status pld_recipe_buffer_size(const pld_recipe* recipe, uint32_t buffer, int32_t width, int32_t height,
                                          uint64_t fragments, uint64_t* bytes, uint64_t* zeroed);

/* Whether a frame can be drawn, as pld_begin() sees it, in pictures up to width x height; textures are not looked at.
     message  null, or room for message_size bytes: why not, in a sentence */
PLD_API pld_status pld_recipe_check(const pld_recipe* recipe, const pld_frame* frame, int32_t width, int32_t height,
                                    char* message, size_t message_size);
/* Of a frame that pld_recipe_check() lets through. How often a pass runs in it, one after the other; 0 for some. */
PLD_API pld_status pld_recipe_repeats(const pld_recipe* recipe, uint32_t pass, const pld_frame* frame,
                                      uint32_t* repeats);
/* Likewise.
     width      of the largest picture, as for pld_recipe_image_size()
     constants  null, or room for size bytes, at least the pass's constants_size
     area       x, y, width and height of viewport and scissor */
PLD_API pld_status pld_recipe_fill(const pld_recipe* recipe, uint32_t pass, uint32_t repeat, const pld_frame* frame,
                                   int32_t width, void* constants, size_t size, int32_t area[4]);

/* PLD_VALUE_BITS_PER_PIXEL, PLD_VALUE_PLANES and PLD_VALUE_GEOMETRY_PASSES, of shadow maps PLD_VALUE_SHADOW_BYTES, as
   pld_query() has them. */
PLD_API pld_status pld_recipe_query(const pld_recipe* recipe, pld_value what, uint64_t* value);

/* Shadow maps of transparent casters: what pld_shadow_begin() and pld_shadow_end() do with one face, as a recipe.
   Images, passes and their texts are asked for by the functions above; the first pass is the host's draws of its
   casters (PLD_STAGE_CASTERS), the others filter the face. Of the functions that take a frame this recipe has none.

   Once: make the images by pld_recipe_image_size(), and a uniform buffer for the table, pld_shadow_recipe_table() with
   a null view. The layers of PLD_ROLE_SHADOW_MAPS can be read from then on, whatever they hold.

   For every face that is drawn, whenever that is: pld_shadow_recipe_check(); for each pass pld_shadow_recipe_fill(),
   and draw; then pld_shadow_recipe_table() for its rows of the table. A light may be looked up once all of
   its faces are drawn.
     info  that of the recipe of frames whose layers ask the maps: the casters' block is where theirs is,
           info.uniform_binding, and what the text of lookups declares lies beside what the layers' text does, in
           the same set, at maps.uniform_binding and maps.texture_unit. What is wrong with it is said as
           pld_recipe_create() says it */
PLD_API pld_status pld_shadow_recipe_create(const pld_recipe_info* info, const pld_shadow_info* maps,
                                            pld_recipe** recipe);
/* As PLD_SHADOW_TEXT_LOOKUP of pld_shadow_glsl(): pldShadow() and pldShadowOnOpaque(), the block PldShadows, which
   holds the table, and the texture array pldShadowMaps. It goes behind the #version line of any shader that asks,
   beside the text of layers or without it. Lives as long as the recipe.
     hash  null, or takes the hash of the text */
PLD_API pld_status pld_shadow_recipe_glsl(const pld_recipe* recipe, const char** text, uint64_t* hash);
/* Whether a face can be drawn, as pld_shadow_begin() sees it; its depth_texture is not looked at. */
PLD_API pld_status pld_shadow_recipe_check(const pld_recipe* recipe, const pld_shadow_view* view, char* message,
                                           size_t message_size);
/* Of a view that pld_shadow_recipe_check() lets through. Every pass runs once.
     constants  null, or room for size bytes, at least the pass's constants_size
     area       x, y, width and height of viewport and scissor
     layer      of PLD_ROLE_SHADOW_MAPS, that of the face's first channel */
PLD_API pld_status pld_shadow_recipe_fill(const pld_recipe* recipe, uint32_t pass, const pld_shadow_view* view,
                                          void* constants, size_t size, int32_t area[4], int32_t* layer);
PLD_API pld_status pld_shadow_recipe_table_size(const pld_recipe* recipe, size_t* bytes);
/* Writes the rows of the view's light and face, and leaves those of others; with a null view all are those of lights
   without a face, through which everything shines.
     rows   PLD_ROWS_UP where NDC's y grows with the rows of the image, as GL has it and Vulkan with a viewport of
            positive height; PLD_ROWS_DOWN where it runs against them: GL_UPPER_LEFT, and negative heights
     table  of size bytes, at least pld_shadow_recipe_table_size() */
PLD_API pld_status pld_shadow_recipe_table(const pld_recipe* recipe, const pld_shadow_view* view, pld_rows rows,
                                           void* table, size_t size);

static inline pld_recipe_info pld_recipe_info_init(pld_dialect dialect, int32_t glsl) {
  pld_recipe_info info;
  memset(&info, 0, sizeof(info));
  info.struct_size = sizeof(info);
  info.version = PLD_VERSION;
  info.dialect = dialect;
  info.glsl = glsl;
  if (dialect == PLD_DIALECT_VULKAN) {
    info.clip = PLD_CLIP_ZERO_TO_ONE;
    info.rows = PLD_ROWS_DOWN;
    info.texture_binding = 1;
    info.storage_binding = 5;
  }
  return info; /* method, tier, features and depth are the host's to say */
}

#ifdef __cplusplus
}
#endif
#endif
