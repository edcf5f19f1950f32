// The OpenGL entry points. OSMesa exports every core function, so no loader library stands between (and -lGL must not
// be linked beside it).
#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/osmesa.h>

#include "engine/core/error.hpp"
