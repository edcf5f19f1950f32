#define TINYGLTF_IMPLEMENTATION
#include "engine/io/meshes/tinygltf.hpp"
