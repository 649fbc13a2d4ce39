#pragma once

// The calling convention of GL. Unless it is defined, glcorearb.h includes windows.h, whose macros replace
// names.
#if defined(_WIN32) && !defined(APIENTRY)
#define APIENTRY __stdcall
#endif
#include <GL/glcorearb.h>

#include <candela/gl_loader.hpp>

/// The functions of OpenGL 4.5 core that are loaded: X(name without "gl", the same in capitals).
// clang-format off
#define CANDELA_GL_FUNCTIONS(X) \
    /* state */ \
    X(Enable, ENABLE) \
    X(Disable, DISABLE) \
    X(IsEnabled, ISENABLED) \
    X(IsTexture, ISTEXTURE) \
    X(Enablei, ENABLEI) \
    X(Disablei, DISABLEI) \
    X(IsEnabledi, ISENABLEDI) \
    X(CullFace, CULLFACE) \
    X(FrontFace, FRONTFACE) \
    X(PolygonMode, POLYGONMODE) \
    X(PolygonOffset, POLYGONOFFSET) \
    X(DepthFunc, DEPTHFUNC) \
    X(DepthMask, DEPTHMASK) \
    X(DepthRangef, DEPTHRANGEF) \
    X(ClipControl, CLIPCONTROL) \
    X(DepthRangeIndexed, DEPTHRANGEINDEXED) \
    X(ColorMask, COLORMASK) \
    X(ColorMaski, COLORMASKI) \
    X(BlendFunc, BLENDFUNC) \
    X(BlendFuncSeparate, BLENDFUNCSEPARATE) \
    X(BlendFuncSeparatei, BLENDFUNCSEPARATEI) \
    X(BlendEquation, BLENDEQUATION) \
    X(BlendEquationSeparatei, BLENDEQUATIONSEPARATEI) \
    X(StencilFunc, STENCILFUNC) \
    X(Viewport, VIEWPORT) \
    X(ViewportIndexedfv, VIEWPORTINDEXEDFV) \
    X(Scissor, SCISSOR) \
    X(PixelStorei, PIXELSTOREI) \
    X(ClearColor, CLEARCOLOR) \
    X(ClearDepthf, CLEARDEPTHF) \
    X(SampleMaski, SAMPLEMASKI) \
    X(ProvokingVertex, PROVOKINGVERTEX) \
    X(PrimitiveRestartIndex, PRIMITIVERESTARTINDEX) \
    /* queries of state */ \
    X(GetError, GETERROR) \
    X(GetString, GETSTRING) \
    X(GetStringi, GETSTRINGI) \
    X(GetFramebufferAttachmentParameteriv, GETFRAMEBUFFERATTACHMENTPARAMETERIV) \
    X(GetIntegerv, GETINTEGERV) \
    X(GetIntegeri_v, GETINTEGERI_V) \
    X(GetInteger64i_v, GETINTEGER64I_V) \
    X(GetFloatv, GETFLOATV) \
    X(GetFloati_v, GETFLOATI_V) \
    X(GetDoublei_v, GETDOUBLEI_V) \
    X(GetBooleanv, GETBOOLEANV) \
    X(GetBooleani_v, GETBOOLEANI_V) \
    X(GetPointerv, GETPOINTERV) \
    /* buffers */ \
    X(CreateBuffers, CREATEBUFFERS) \
    X(DeleteBuffers, DELETEBUFFERS) \
    X(NamedBufferStorage, NAMEDBUFFERSTORAGE) \
    X(NamedBufferSubData, NAMEDBUFFERSUBDATA) \
    X(GetNamedBufferSubData, GETNAMEDBUFFERSUBDATA) \
    X(CopyNamedBufferSubData, COPYNAMEDBUFFERSUBDATA) \
    X(BindBuffer, BINDBUFFER) \
    X(BindBufferBase, BINDBUFFERBASE) \
    X(BindBufferRange, BINDBUFFERRANGE) \
    X(GetNamedBufferParameteri64v, GETNAMEDBUFFERPARAMETERI64V) \
    /* textures */ \
    X(CreateTextures, CREATETEXTURES) \
    X(TextureBuffer, TEXTUREBUFFER) \
    X(GenTextures, GENTEXTURES) \
    X(TextureView, TEXTUREVIEW) \
    X(DeleteTextures, DELETETEXTURES) \
    X(TextureStorage2D, TEXTURESTORAGE2D) \
    X(TextureStorage3D, TEXTURESTORAGE3D) \
    X(TextureSubImage2D, TEXTURESUBIMAGE2D) \
    X(TextureSubImage3D, TEXTURESUBIMAGE3D) \
    X(TextureParameteri, TEXTUREPARAMETERI) \
    X(GetTextureSubImage, GETTEXTURESUBIMAGE) \
    X(CopyImageSubData, COPYIMAGESUBDATA) \
    X(GetTextureParameteriv, GETTEXTUREPARAMETERIV) \
    X(GetTextureLevelParameteriv, GETTEXTURELEVELPARAMETERIV) \
    X(GenerateTextureMipmap, GENERATETEXTUREMIPMAP) \
    X(ClearNamedBufferData, CLEARNAMEDBUFFERDATA) \
    X(ClearTexImage, CLEARTEXIMAGE) \
    X(ClearTexSubImage, CLEARTEXSUBIMAGE) \
    X(BindTexture, BINDTEXTURE) \
    X(BindTextureUnit, BINDTEXTUREUNIT) \
    X(ActiveTexture, ACTIVETEXTURE) \
    X(BindImageTexture, BINDIMAGETEXTURE) \
    /* samplers */ \
    X(CreateSamplers, CREATESAMPLERS) \
    X(DeleteSamplers, DELETESAMPLERS) \
    X(SamplerParameteri, SAMPLERPARAMETERI) \
    X(SamplerParameterf, SAMPLERPARAMETERF) \
    X(GetSamplerParameteriv, GETSAMPLERPARAMETERIV) \
    X(BindSampler, BINDSAMPLER) \
    /* framebuffers */ \
    X(CreateFramebuffers, CREATEFRAMEBUFFERS) \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS) \
    X(NamedFramebufferTexture, NAMEDFRAMEBUFFERTEXTURE) \
    X(NamedFramebufferTextureLayer, NAMEDFRAMEBUFFERTEXTURELAYER) \
    X(NamedFramebufferDrawBuffers, NAMEDFRAMEBUFFERDRAWBUFFERS) \
    X(CheckNamedFramebufferStatus, CHECKNAMEDFRAMEBUFFERSTATUS) \
    X(GetNamedFramebufferAttachmentParameteriv, GETNAMEDFRAMEBUFFERATTACHMENTPARAMETERIV) \
    X(GetNamedRenderbufferParameteriv, GETNAMEDRENDERBUFFERPARAMETERIV) \
    X(IsFramebuffer, ISFRAMEBUFFER) \
    X(BindFramebuffer, BINDFRAMEBUFFER) \
    X(ClearNamedFramebufferfv, CLEARNAMEDFRAMEBUFFERFV) \
    X(ReadPixels, READPIXELS) \
    X(Clear, CLEAR) \
    X(ClearBufferfv, CLEARBUFFERFV) \
    /* vertex arrays */ \
    X(CreateVertexArrays, CREATEVERTEXARRAYS) \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS) \
    X(IsVertexArray, ISVERTEXARRAY) \
    X(BindVertexArray, BINDVERTEXARRAY) \
    X(VertexArrayVertexBuffer, VERTEXARRAYVERTEXBUFFER) \
    X(VertexArrayElementBuffer, VERTEXARRAYELEMENTBUFFER) \
    X(VertexArrayAttribFormat, VERTEXARRAYATTRIBFORMAT) \
    X(VertexArrayAttribIFormat, VERTEXARRAYATTRIBIFORMAT) \
    X(VertexArrayAttribBinding, VERTEXARRAYATTRIBBINDING) \
    X(VertexArrayBindingDivisor, VERTEXARRAYBINDINGDIVISOR) \
    X(EnableVertexArrayAttrib, ENABLEVERTEXARRAYATTRIB) \
    /* programs */ \
    X(CreateShader, CREATESHADER) \
    X(DeleteShader, DELETESHADER) \
    X(ShaderSource, SHADERSOURCE) \
    X(CompileShader, COMPILESHADER) \
    X(GetShaderiv, GETSHADERIV) \
    X(GetShaderInfoLog, GETSHADERINFOLOG) \
    X(CreateProgram, CREATEPROGRAM) \
    X(DeleteProgram, DELETEPROGRAM) \
    X(AttachShader, ATTACHSHADER) \
    X(DetachShader, DETACHSHADER) \
    X(LinkProgram, LINKPROGRAM) \
    X(IsProgram, ISPROGRAM) \
    X(UseProgram, USEPROGRAM) \
    X(ProgramParameteri, PROGRAMPARAMETERI) \
    X(GetProgramBinary, GETPROGRAMBINARY) \
    X(ProgramBinary, PROGRAMBINARY) \
    X(GetProgramiv, GETPROGRAMIV) \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG) \
    X(GetProgramInterfaceiv, GETPROGRAMINTERFACEIV) \
    X(GetProgramResourceIndex, GETPROGRAMRESOURCEINDEX) \
    X(GetProgramResourceName, GETPROGRAMRESOURCENAME) \
    X(GetProgramResourceiv, GETPROGRAMRESOURCEIV) \
    X(GetProgramResourceLocation, GETPROGRAMRESOURCELOCATION) \
    X(ProgramUniform1i, PROGRAMUNIFORM1I) \
    X(ProgramUniform1ui, PROGRAMUNIFORM1UI) \
    X(ProgramUniform1f, PROGRAMUNIFORM1F) \
    X(ProgramUniform2fv, PROGRAMUNIFORM2FV) \
    X(ProgramUniform3fv, PROGRAMUNIFORM3FV) \
    X(ProgramUniform4fv, PROGRAMUNIFORM4FV) \
    X(ProgramUniform2uiv, PROGRAMUNIFORM2UIV) \
    X(ProgramUniformMatrix3fv, PROGRAMUNIFORMMATRIX3FV) \
    X(ProgramUniformMatrix4fv, PROGRAMUNIFORMMATRIX4FV) \
    /* draws and dispatches */ \
    X(DrawArrays, DRAWARRAYS) \
    X(DrawElements, DRAWELEMENTS) \
    X(MultiDrawElementsIndirect, MULTIDRAWELEMENTSINDIRECT) \
    X(DispatchCompute, DISPATCHCOMPUTE) \
    X(DispatchComputeIndirect, DISPATCHCOMPUTEINDIRECT) \
    X(MemoryBarrier, MEMORYBARRIER) \
    X(Finish, FINISH) \
    X(PauseTransformFeedback, PAUSETRANSFORMFEEDBACK) \
    X(ResumeTransformFeedback, RESUMETRANSFORMFEEDBACK) \
    /* queries and fences */ \
    X(CreateQueries, CREATEQUERIES) \
    X(DeleteQueries, DELETEQUERIES) \
    X(QueryCounter, QUERYCOUNTER) \
    X(GetQueryObjectiv, GETQUERYOBJECTIV) \
    X(GetQueryObjectui64v, GETQUERYOBJECTUI64V) \
    /* debug output */ \
    X(DebugMessageCallback, DEBUGMESSAGECALLBACK) \
    X(DebugMessageInsert, DEBUGMESSAGEINSERT) \
    X(PushDebugGroup, PUSHDEBUGGROUP) \
    X(PopDebugGroup, POPDEBUGGROUP) \
    X(ObjectLabel, OBJECTLABEL) \
    X(GetObjectLabel, GETOBJECTLABEL)  // clang-format on

namespace candela::gl {

/// Function pointers of one context. `functions.DrawArrays(...)` calls glDrawArrays.
struct Functions {
    // NOLINTBEGIN(readability-identifier-naming): named as in OpenGL
#define CANDELA_GL_MEMBER(name, capitals) PFNGL##capitals##PROC name = nullptr;
    CANDELA_GL_FUNCTIONS(CANDELA_GL_MEMBER)
#undef CANDELA_GL_MEMBER
    /// Of GL_KHR_parallel_shader_compile or GL_ARB_parallel_shader_compile; null if the driver has neither.
    PFNGLMAXSHADERCOMPILERTHREADSKHRPROC MaxShaderCompilerThreadsKHR = nullptr;
    // NOLINTEND(readability-identifier-naming)
};

/// A number that glGetIntegerv returns: the name of an object, an enumeration or a count.
[[nodiscard]] GLuint get_unsigned(const Functions& gl, GLenum what);

void set_enabled(const Functions& gl, GLenum capability, bool enabled);

/// Looks up every function of OpenGL 4.5. Throws GlError that names the first missing one.
[[nodiscard]] Functions load_functions(const GetProc& get_proc);

}  // namespace candela::gl
