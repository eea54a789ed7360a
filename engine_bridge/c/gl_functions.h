// OpenGL as the host's get_proc_address hands it out: this library links no GL and shares no loader with the host.
#pragma once
#include <GL/glcorearb.h>

#include <string>

#include "engine_bridge/include/pellucid/pellucid.h"

namespace pellucid::c {

// Of OpenGL 3.3. A context that lacks one is refused.
#define PLD_GL_REQUIRED(X)                                                             \
  X(ActiveTexture, PFNGLACTIVETEXTUREPROC)                                             \
  X(AttachShader, PFNGLATTACHSHADERPROC)                                               \
  X(BeginQuery, PFNGLBEGINQUERYPROC)                                                   \
  X(BindBuffer, PFNGLBINDBUFFERPROC)                                                   \
  X(BindBufferBase, PFNGLBINDBUFFERBASEPROC)                                           \
  X(BindBufferRange, PFNGLBINDBUFFERRANGEPROC)                                         \
  X(BindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                                         \
  X(BindSampler, PFNGLBINDSAMPLERPROC)                                                 \
  X(BindTexture, PFNGLBINDTEXTUREPROC)                                                 \
  X(BindVertexArray, PFNGLBINDVERTEXARRAYPROC)                                         \
  X(BlendEquationSeparate, PFNGLBLENDEQUATIONSEPARATEPROC)                             \
  X(BlendFuncSeparate, PFNGLBLENDFUNCSEPARATEPROC)                                     \
  X(BufferData, PFNGLBUFFERDATAPROC)                                                   \
  X(BufferSubData, PFNGLBUFFERSUBDATAPROC)                                             \
  X(CheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)                           \
  X(ClearBufferfv, PFNGLCLEARBUFFERFVPROC)                                             \
  X(ColorMask, PFNGLCOLORMASKPROC)                                                     \
  X(ColorMaski, PFNGLCOLORMASKIPROC)                                                   \
  X(CompileShader, PFNGLCOMPILESHADERPROC)                                             \
  X(CreateProgram, PFNGLCREATEPROGRAMPROC)                                             \
  X(CreateShader, PFNGLCREATESHADERPROC)                                               \
  X(DeleteBuffers, PFNGLDELETEBUFFERSPROC)                                             \
  X(DeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)                                   \
  X(DeleteProgram, PFNGLDELETEPROGRAMPROC)                                             \
  X(DeleteQueries, PFNGLDELETEQUERIESPROC)                                             \
  X(DeleteSamplers, PFNGLDELETESAMPLERSPROC)                                           \
  X(DeleteShader, PFNGLDELETESHADERPROC)                                               \
  X(DeleteTextures, PFNGLDELETETEXTURESPROC)                                           \
  X(DeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)                                   \
  X(DepthFunc, PFNGLDEPTHFUNCPROC)                                                     \
  X(DepthMask, PFNGLDEPTHMASKPROC)                                                     \
  X(Disable, PFNGLDISABLEPROC)                                                         \
  X(Disablei, PFNGLDISABLEIPROC)                                                       \
  X(DrawArrays, PFNGLDRAWARRAYSPROC)                                                   \
  X(DrawBuffers, PFNGLDRAWBUFFERSPROC)                                                 \
  X(Enable, PFNGLENABLEPROC)                                                           \
  X(Enablei, PFNGLENABLEIPROC)                                                         \
  X(EndQuery, PFNGLENDQUERYPROC)                                                       \
  X(FramebufferTexture2D, PFNGLFRAMEBUFFERTEXTURE2DPROC)                               \
  X(FramebufferTextureLayer, PFNGLFRAMEBUFFERTEXTURELAYERPROC)                         \
  X(GenBuffers, PFNGLGENBUFFERSPROC)                                                   \
  X(GenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                                         \
  X(GenQueries, PFNGLGENQUERIESPROC)                                                   \
  X(GenSamplers, PFNGLGENSAMPLERSPROC)                                                 \
  X(GenTextures, PFNGLGENTEXTURESPROC)                                                 \
  X(GenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                                         \
  X(GetActiveUniformBlockiv, PFNGLGETACTIVEUNIFORMBLOCKIVPROC)                         \
  X(GetBooleani_v, PFNGLGETBOOLEANI_VPROC)                                             \
  X(GetBooleanv, PFNGLGETBOOLEANVPROC)                                                 \
  X(GetError, PFNGLGETERRORPROC)                                                       \
  X(GetFramebufferAttachmentParameteriv, PFNGLGETFRAMEBUFFERATTACHMENTPARAMETERIVPROC) \
  X(GetInteger64i_v, PFNGLGETINTEGER64I_VPROC)                                         \
  X(GetIntegeri_v, PFNGLGETINTEGERI_VPROC)                                             \
  X(GetIntegerv, PFNGLGETINTEGERVPROC)                                                 \
  X(GetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)                                     \
  X(GetProgramiv, PFNGLGETPROGRAMIVPROC)                                               \
  X(GetQueryObjectiv, PFNGLGETQUERYOBJECTIVPROC)                                       \
  X(GetQueryObjectui64v, PFNGLGETQUERYOBJECTUI64VPROC)                                 \
  X(GetQueryiv, PFNGLGETQUERYIVPROC)                                                   \
  X(GetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)                                       \
  X(GetShaderiv, PFNGLGETSHADERIVPROC)                                                 \
  X(GetStringi, PFNGLGETSTRINGIPROC)                                                   \
  X(GetTexLevelParameteriv, PFNGLGETTEXLEVELPARAMETERIVPROC)                           \
  X(GetUniformBlockIndex, PFNGLGETUNIFORMBLOCKINDEXPROC)                               \
  X(GetUniformIndices, PFNGLGETUNIFORMINDICESPROC)                                     \
  X(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)                                   \
  X(GetUniformiv, PFNGLGETUNIFORMIVPROC)                                               \
  X(IsEnabled, PFNGLISENABLEDPROC)                                                     \
  X(IsEnabledi, PFNGLISENABLEDIPROC)                                                   \
  X(IsFramebuffer, PFNGLISFRAMEBUFFERPROC)                                             \
  X(IsBuffer, PFNGLISBUFFERPROC)                                                       \
  X(IsProgram, PFNGLISPROGRAMPROC)                                                     \
  X(IsTexture, PFNGLISTEXTUREPROC)                                                     \
  X(IsVertexArray, PFNGLISVERTEXARRAYPROC)                                             \
  X(LinkProgram, PFNGLLINKPROGRAMPROC)                                                 \
  X(PolygonMode, PFNGLPOLYGONMODEPROC)                                                 \
  X(QueryCounter, PFNGLQUERYCOUNTERPROC)                                               \
  X(SamplerParameteri, PFNGLSAMPLERPARAMETERIPROC)                                     \
  X(ShaderSource, PFNGLSHADERSOURCEPROC)                                               \
  X(TexImage2D, PFNGLTEXIMAGE2DPROC)                                                   \
  X(TexImage3D, PFNGLTEXIMAGE3DPROC)                                                   \
  X(TexParameteri, PFNGLTEXPARAMETERIPROC)                                             \
  X(Uniform1f, PFNGLUNIFORM1FPROC)                                                     \
  X(Uniform1i, PFNGLUNIFORM1IPROC)                                                     \
  X(Uniform2i, PFNGLUNIFORM2IPROC)                                                     \
  X(Uniform3i, PFNGLUNIFORM3IPROC)                                                     \
  X(Uniform4f, PFNGLUNIFORM4FPROC)                                                     \
  X(Uniform4iv, PFNGLUNIFORM4IVPROC)                                                   \
  X(UniformBlockBinding, PFNGLUNIFORMBLOCKBINDINGPROC)                                 \
  X(UseProgram, PFNGLUSEPROGRAMPROC)                                                   \
  X(Viewport, PFNGLVIEWPORTPROC)

// Of later versions and of extensions: null where the context does not say it has them.
#define PLD_GL_OPTIONAL(X)                                   \
  X(BlendEquationSeparatei, PFNGLBLENDEQUATIONSEPARATEIPROC) \
  X(BlendFuncSeparatei, PFNGLBLENDFUNCSEPARATEIPROC)         \
  X(ClearBufferSubData, PFNGLCLEARBUFFERSUBDATAPROC)         \
  X(GetBufferSubData, PFNGLGETBUFFERSUBDATAPROC)             \
  X(GetInteger64v, PFNGLGETINTEGER64VPROC)                   \
  X(GetFloati_v, PFNGLGETFLOATI_VPROC)                       \
  X(GetObjectLabel, PFNGLGETOBJECTLABELPROC)                 \
  X(GetTextureParameteriv, PFNGLGETTEXTUREPARAMETERIVPROC)   \
  X(MemoryBarrier, PFNGLMEMORYBARRIERPROC)                   \
  X(ObjectLabel, PFNGLOBJECTLABELPROC)                       \
  X(PopDebugGroup, PFNGLPOPDEBUGGROUPPROC)                   \
  X(PushDebugGroup, PFNGLPUSHDEBUGGROUPPROC)                 \
  X(TextureBarrier, PFNGLTEXTUREBARRIERPROC)                 \
  X(ViewportIndexedf, PFNGLVIEWPORTINDEXEDFPROC)

constexpr int kDrawBuffers = 8;  // what OpenGL 3.3 promises; others are not touched

struct GlFunctions {
#define PLD_GL_MEMBER(name, type) type name = nullptr;
  PLD_GL_REQUIRED(PLD_GL_MEMBER)
  PLD_GL_OPTIONAL(PLD_GL_MEMBER)
#undef PLD_GL_MEMBER
  int version = 0;           // 10 major + minor
  bool onProcessor = false;  // rasterised by Mesa, without a device
  bool core = false;
  bool clipControl = false;
  bool fewBuffers = false;  // the device has no more draw buffers than this library touches
};

// Empty when `gl` holds everything, else what is missing: "OpenGL 3.3, found 2.1". The host's context is current.
std::string load(pld_get_proc_address get, void* user, GlFunctions& gl);

}  // namespace pellucid::c
