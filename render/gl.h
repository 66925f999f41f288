// OpenGL 4.5 core, as libOpenGL exports it: no loader is needed.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
