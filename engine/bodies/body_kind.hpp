// static: no degrees of freedom, never moves. scripted: its pose is a given function of time. dynamic: 6 DoF.
// deformable: 3 DoF a node that is not held.
#pragma once

namespace impinge {

enum class BodyKind { fixed, scripted, dynamic, deformable };  // "static" is a word of the language
const char* kind_name(BodyKind kind);                          // static | scripted | dynamic | deformable

}  // namespace impinge
