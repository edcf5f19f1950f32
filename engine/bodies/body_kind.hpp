// static: no degrees of freedom, never moves. scripted: its pose is a given function of time. dynamic: 6 DoF.
#pragma once

namespace impinge {

enum class BodyKind { fixed, scripted, dynamic };  // "static" is a word of the language
const char* kind_name(BodyKind kind);              // static | scripted | dynamic

}  // namespace impinge
