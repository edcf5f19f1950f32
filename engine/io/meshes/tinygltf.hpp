// tinygltf, compiled here and under a name of its own: Debian's libdraco, which assimp loads, exports another version's
// symbols, and whichever library comes first answers for both. Without its reading and writing of pictures.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf impinge_tinygltf
#include <tiny_gltf.h>
