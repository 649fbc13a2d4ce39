#pragma once

#include <GL/glcorearb.h>

#include <candela/gl_loader.hpp>

/// The functions of OpenGL 4.5 core that are loaded: X(name without "gl", the same in capitals).
// clang-format off
#define CANDELA_GL_FUNCTIONS(X) \
    /* state */ \
    X(Enable, ENABLE) \
    X(Disable, DISABLE) \
    X(IsEnabled, ISENABLED) \
    X(Enablei, ENABLEI) \
    X(Disablei, DISABLEI) \
    X(CullFace, CULLFACE) \
    X(FrontFace, FRONTFACE) \
    X(PolygonMode, POLYGONMODE) \
    X(PolygonOffset, POLYGONOFFSET) \
    X(PolygonOffsetClamp, POLYGONOFFSETCLAMP) \
    X(LineWidth, LINEWIDTH) \
    X(DepthFunc, DEPTHFUNC) \
    X(DepthMask, DEPTHMASK) \
    X(DepthRangef, DEPTHRANGEF) \
    X(ClipControl, CLIPCONTROL) \
    X(ColorMask, COLORMASK) \
    X(ColorMaski, COLORMASKI) \
    X(BlendFunc, BLENDFUNC) \
    X(BlendFuncSeparate, BLENDFUNCSEPARATE) \
    X(BlendFunci, BLENDFUNCI) \
    X(BlendEquation, BLENDEQUATION) \
    X(BlendEquationSeparate, BLENDEQUATIONSEPARATE) \
    X(BlendEquationi, BLENDEQUATIONI) \
    X(BlendColor, BLENDCOLOR) \
    X(StencilFunc, STENCILFUNC) \
    X(StencilOp, STENCILOP) \
    X(StencilMask, STENCILMASK) \
    X(Viewport, VIEWPORT) \
    X(ViewportIndexedf, VIEWPORTINDEXEDF) \
    X(Scissor, SCISSOR) \
    X(PixelStorei, PIXELSTOREI) \
    X(Hint, HINT) \
    X(ClearColor, CLEARCOLOR) \
    X(ClearDepthf, CLEARDEPTHF) \
    X(SampleMaski, SAMPLEMASKI) \
    X(PrimitiveRestartIndex, PRIMITIVERESTARTINDEX) \
    /* queries of state */ \
    X(GetError, GETERROR) \
    X(GetString, GETSTRING) \
    X(GetStringi, GETSTRINGI) \
    X(GetIntegerv, GETINTEGERV) \
    X(GetIntegeri_v, GETINTEGERI_V) \
    X(GetInteger64v, GETINTEGER64V) \
    X(GetFloatv, GETFLOATV) \
    X(GetBooleanv, GETBOOLEANV) \
    X(GetBooleani_v, GETBOOLEANI_V) \
    X(GetFloati_v, GETFLOATI_V) \
    X(GetPointerv, GETPOINTERV) \
    X(GetGraphicsResetStatus, GETGRAPHICSRESETSTATUS) \
    /* buffers */ \
    X(CreateBuffers, CREATEBUFFERS) \
    X(DeleteBuffers, DELETEBUFFERS) \
    X(NamedBufferStorage, NAMEDBUFFERSTORAGE) \
    X(NamedBufferData, NAMEDBUFFERDATA) \
    X(NamedBufferSubData, NAMEDBUFFERSUBDATA) \
    X(GetNamedBufferSubData, GETNAMEDBUFFERSUBDATA) \
    X(CopyNamedBufferSubData, COPYNAMEDBUFFERSUBDATA) \
    X(ClearNamedBufferData, CLEARNAMEDBUFFERDATA) \
    X(ClearNamedBufferSubData, CLEARNAMEDBUFFERSUBDATA) \
    X(MapNamedBufferRange, MAPNAMEDBUFFERRANGE) \
    X(UnmapNamedBuffer, UNMAPNAMEDBUFFER) \
    X(FlushMappedNamedBufferRange, FLUSHMAPPEDNAMEDBUFFERRANGE) \
    X(GetNamedBufferParameteri64v, GETNAMEDBUFFERPARAMETERI64V) \
    X(InvalidateBufferData, INVALIDATEBUFFERDATA) \
    X(InvalidateBufferSubData, INVALIDATEBUFFERSUBDATA) \
    X(BindBuffer, BINDBUFFER) \
    X(BindBufferBase, BINDBUFFERBASE) \
    X(BindBufferRange, BINDBUFFERRANGE) \
    X(BindBuffersBase, BINDBUFFERSBASE) \
    X(BindBuffersRange, BINDBUFFERSRANGE) \
    /* textures */ \
    X(CreateTextures, CREATETEXTURES) \
    X(GenTextures, GENTEXTURES) \
    X(DeleteTextures, DELETETEXTURES) \
    X(TextureStorage2D, TEXTURESTORAGE2D) \
    X(TextureStorage3D, TEXTURESTORAGE3D) \
    X(TextureStorage2DMultisample, TEXTURESTORAGE2DMULTISAMPLE) \
    X(TextureSubImage2D, TEXTURESUBIMAGE2D) \
    X(TextureSubImage3D, TEXTURESUBIMAGE3D) \
    X(TextureView, TEXTUREVIEW) \
    X(TextureParameteri, TEXTUREPARAMETERI) \
    X(TextureParameterf, TEXTUREPARAMETERF) \
    X(TextureParameteriv, TEXTUREPARAMETERIV) \
    X(TextureParameterfv, TEXTUREPARAMETERFV) \
    X(GetTextureImage, GETTEXTUREIMAGE) \
    X(GetTextureSubImage, GETTEXTURESUBIMAGE) \
    X(GetTextureParameteriv, GETTEXTUREPARAMETERIV) \
    X(GetTextureLevelParameteriv, GETTEXTURELEVELPARAMETERIV) \
    X(GenerateTextureMipmap, GENERATETEXTUREMIPMAP) \
    X(ClearTexImage, CLEARTEXIMAGE) \
    X(ClearTexSubImage, CLEARTEXSUBIMAGE) \
    X(CopyImageSubData, COPYIMAGESUBDATA) \
    X(InvalidateTexImage, INVALIDATETEXIMAGE) \
    X(InvalidateTexSubImage, INVALIDATETEXSUBIMAGE) \
    X(BindTextureUnit, BINDTEXTUREUNIT) \
    X(BindTextures, BINDTEXTURES) \
    X(ActiveTexture, ACTIVETEXTURE) \
    X(BindTexture, BINDTEXTURE) \
    X(BindImageTexture, BINDIMAGETEXTURE) \
    X(BindImageTextures, BINDIMAGETEXTURES) \
    /* samplers */ \
    X(CreateSamplers, CREATESAMPLERS) \
    X(DeleteSamplers, DELETESAMPLERS) \
    X(SamplerParameteri, SAMPLERPARAMETERI) \
    X(SamplerParameterf, SAMPLERPARAMETERF) \
    X(SamplerParameterfv, SAMPLERPARAMETERFV) \
    X(GetSamplerParameteriv, GETSAMPLERPARAMETERIV) \
    X(BindSampler, BINDSAMPLER) \
    X(BindSamplers, BINDSAMPLERS) \
    /* framebuffers */ \
    X(CreateFramebuffers, CREATEFRAMEBUFFERS) \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS) \
    X(NamedFramebufferTexture, NAMEDFRAMEBUFFERTEXTURE) \
    X(NamedFramebufferTextureLayer, NAMEDFRAMEBUFFERTEXTURELAYER) \
    X(NamedFramebufferDrawBuffer, NAMEDFRAMEBUFFERDRAWBUFFER) \
    X(NamedFramebufferDrawBuffers, NAMEDFRAMEBUFFERDRAWBUFFERS) \
    X(NamedFramebufferReadBuffer, NAMEDFRAMEBUFFERREADBUFFER) \
    X(NamedFramebufferParameteri, NAMEDFRAMEBUFFERPARAMETERI) \
    X(CheckNamedFramebufferStatus, CHECKNAMEDFRAMEBUFFERSTATUS) \
    X(BindFramebuffer, BINDFRAMEBUFFER) \
    X(BlitNamedFramebuffer, BLITNAMEDFRAMEBUFFER) \
    X(ClearNamedFramebufferfv, CLEARNAMEDFRAMEBUFFERFV) \
    X(ClearNamedFramebufferiv, CLEARNAMEDFRAMEBUFFERIV) \
    X(ClearNamedFramebufferuiv, CLEARNAMEDFRAMEBUFFERUIV) \
    X(ClearNamedFramebufferfi, CLEARNAMEDFRAMEBUFFERFI) \
    X(InvalidateNamedFramebufferData, INVALIDATENAMEDFRAMEBUFFERDATA) \
    X(GetNamedFramebufferAttachmentParameteriv, GETNAMEDFRAMEBUFFERATTACHMENTPARAMETERIV) \
    X(ReadPixels, READPIXELS) \
    X(Clear, CLEAR) \
    X(ClearBufferfv, CLEARBUFFERFV) \
    /* vertex arrays */ \
    X(CreateVertexArrays, CREATEVERTEXARRAYS) \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS) \
    X(BindVertexArray, BINDVERTEXARRAY) \
    X(VertexArrayVertexBuffer, VERTEXARRAYVERTEXBUFFER) \
    X(VertexArrayElementBuffer, VERTEXARRAYELEMENTBUFFER) \
    X(VertexArrayAttribFormat, VERTEXARRAYATTRIBFORMAT) \
    X(VertexArrayAttribIFormat, VERTEXARRAYATTRIBIFORMAT) \
    X(VertexArrayAttribBinding, VERTEXARRAYATTRIBBINDING) \
    X(VertexArrayBindingDivisor, VERTEXARRAYBINDINGDIVISOR) \
    X(EnableVertexArrayAttrib, ENABLEVERTEXARRAYATTRIB) \
    X(DisableVertexArrayAttrib, DISABLEVERTEXARRAYATTRIB) \
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
    X(ValidateProgram, VALIDATEPROGRAM) \
    X(UseProgram, USEPROGRAM) \
    X(GetProgramiv, GETPROGRAMIV) \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG) \
    X(GetUniformLocation, GETUNIFORMLOCATION) \
    X(GetProgramInterfaceiv, GETPROGRAMINTERFACEIV) \
    X(GetProgramResourceIndex, GETPROGRAMRESOURCEINDEX) \
    X(GetProgramResourceName, GETPROGRAMRESOURCENAME) \
    X(GetProgramResourceiv, GETPROGRAMRESOURCEIV) \
    X(GetProgramResourceLocation, GETPROGRAMRESOURCELOCATION) \
    X(ProgramUniform1i, PROGRAMUNIFORM1I) \
    X(ProgramUniform1iv, PROGRAMUNIFORM1IV) \
    X(ProgramUniform1ui, PROGRAMUNIFORM1UI) \
    X(ProgramUniform1uiv, PROGRAMUNIFORM1UIV) \
    X(ProgramUniform1f, PROGRAMUNIFORM1F) \
    X(ProgramUniform1fv, PROGRAMUNIFORM1FV) \
    X(ProgramUniform2fv, PROGRAMUNIFORM2FV) \
    X(ProgramUniform3fv, PROGRAMUNIFORM3FV) \
    X(ProgramUniform4fv, PROGRAMUNIFORM4FV) \
    X(ProgramUniform2iv, PROGRAMUNIFORM2IV) \
    X(ProgramUniform3iv, PROGRAMUNIFORM3IV) \
    X(ProgramUniform4iv, PROGRAMUNIFORM4IV) \
    X(ProgramUniform2uiv, PROGRAMUNIFORM2UIV) \
    X(ProgramUniform3uiv, PROGRAMUNIFORM3UIV) \
    X(ProgramUniform4uiv, PROGRAMUNIFORM4UIV) \
    X(ProgramUniformMatrix3fv, PROGRAMUNIFORMMATRIX3FV) \
    X(ProgramUniformMatrix4fv, PROGRAMUNIFORMMATRIX4FV) \
    X(ShaderStorageBlockBinding, SHADERSTORAGEBLOCKBINDING) \
    X(UniformBlockBinding, UNIFORMBLOCKBINDING) \
    /* draws and dispatches */ \
    X(DrawArrays, DRAWARRAYS) \
    X(DrawArraysInstanced, DRAWARRAYSINSTANCED) \
    X(DrawArraysInstancedBaseInstance, DRAWARRAYSINSTANCEDBASEINSTANCE) \
    X(DrawArraysIndirect, DRAWARRAYSINDIRECT) \
    X(DrawElements, DRAWELEMENTS) \
    X(DrawElementsBaseVertex, DRAWELEMENTSBASEVERTEX) \
    X(DrawElementsInstanced, DRAWELEMENTSINSTANCED) \
    X(DrawElementsInstancedBaseVertexBaseInstance, DRAWELEMENTSINSTANCEDBASEVERTEXBASEINSTANCE) \
    X(DrawElementsIndirect, DRAWELEMENTSINDIRECT) \
    X(MultiDrawArraysIndirect, MULTIDRAWARRAYSINDIRECT) \
    X(MultiDrawElementsIndirect, MULTIDRAWELEMENTSINDIRECT) \
    X(DispatchCompute, DISPATCHCOMPUTE) \
    X(DispatchComputeIndirect, DISPATCHCOMPUTEINDIRECT) \
    X(MemoryBarrier, MEMORYBARRIER) \
    X(MemoryBarrierByRegion, MEMORYBARRIERBYREGION) \
    X(TextureBarrier, TEXTUREBARRIER) \
    X(Flush, FLUSH) \
    X(Finish, FINISH) \
    /* queries and fences */ \
    X(CreateQueries, CREATEQUERIES) \
    X(DeleteQueries, DELETEQUERIES) \
    X(BeginQuery, BEGINQUERY) \
    X(EndQuery, ENDQUERY) \
    X(QueryCounter, QUERYCOUNTER) \
    X(GetQueryiv, GETQUERYIV) \
    X(GetQueryObjectiv, GETQUERYOBJECTIV) \
    X(GetQueryObjectuiv, GETQUERYOBJECTUIV) \
    X(GetQueryObjecti64v, GETQUERYOBJECTI64V) \
    X(GetQueryObjectui64v, GETQUERYOBJECTUI64V) \
    X(FenceSync, FENCESYNC) \
    X(DeleteSync, DELETESYNC) \
    X(ClientWaitSync, CLIENTWAITSYNC) \
    X(WaitSync, WAITSYNC) \
    X(GetSynciv, GETSYNCIV) \
    /* debug output */ \
    X(DebugMessageCallback, DEBUGMESSAGECALLBACK) \
    X(DebugMessageControl, DEBUGMESSAGECONTROL) \
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
    // NOLINTEND(readability-identifier-naming)
};

/// Looks up every function. Throws GlError that names the first missing one.
[[nodiscard]] Functions load_functions(const GetProc& get_proc);

}  // namespace candela::gl
