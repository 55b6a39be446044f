/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "pixels/gl.h"

#include <GL/glcorearb.h>

/* The OpenGL functions that the renderer calls, loaded at run time through the context. */

#define GL_FUNCTIONS(X)                                          \
    X(PFNGLATTACHSHADERPROC, AttachShader)                       \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                           \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                 \
    X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)               \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                         \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                 \
    X(PFNGLBLENDFUNCSEPARATEPROC, BlendFuncSeparate)             \
    X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                 \
    X(PFNGLBUFFERDATAPROC, BufferData)                           \
    X(PFNGLBUFFERSUBDATAPROC, BufferSubData)                     \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)   \
    X(PFNGLCLEARPROC, Clear)                                     \
    X(PFNGLCLEARCOLORPROC, ClearColor)                           \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                     \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                     \
    X(PFNGLCREATESHADERPROC, CreateShader)                       \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                     \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)           \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                     \
    X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)         \
    X(PFNGLDELETESHADERPROC, DeleteShader)                       \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                   \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)           \
    X(PFNGLDISABLEPROC, Disable)                                 \
    X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)         \
    X(PFNGLENABLEPROC, Enable)                                   \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray) \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer) \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                           \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                 \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)               \
    X(PFNGLGENTEXTURESPROC, GenTextures)                         \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                 \
    X(PFNGLGETERRORPROC, GetError)                               \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                         \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)             \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                       \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)               \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                         \
    X(PFNGLGETSTRINGPROC, GetString)                             \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)           \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                         \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                         \
    X(PFNGLREADPIXELSPROC, ReadPixels)                           \
    X(PFNGLRENDERBUFFERSTORAGEPROC, RenderbufferStorage)         \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                       \
    X(PFNGLTEXBUFFERPROC, TexBuffer)                             \
    X(PFNGLUNIFORM2IPROC, Uniform2i)                             \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                           \
    X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)         \
    X(PFNGLVERTEXATTRIBIPOINTERPROC, VertexAttribIPointer)       \
    X(PFNGLVIEWPORTPROC, Viewport)

/* Called as gl->Clear(...). */
struct GlFunctions {
#define DECLARE(type, name) type name;
    GL_FUNCTIONS(DECLARE)
#undef DECLARE
};
