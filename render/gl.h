// OpenGL 4.5 core, as libOpenGL exports it: no loader is needed.
#pragma once

#include <GL/glcorearb.h>
