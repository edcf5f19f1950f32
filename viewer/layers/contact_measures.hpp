// What a contact shows beside its state, for colours, sizes and tables.
#pragma once

#include "engine/world/step_record.hpp"
#include "viewer/draw/draw_list.hpp"

namespace impinge {

enum class ContactMeasure { overlap, impulse, slip, residual };

/// How deep the bodies overlap there, m; the normal impulse, N s; how fast the two points slide along each other, m/s;
/// how far the answer is from Coulomb's law, relative (ContactRecord::residual).
double measure_of(const StepRecord& record, const ContactRecord& contact, ContactMeasure what);

/// Its colours, with numbers in the prefix that the upper end has few figures in.
ColorBar bar_of(ContactMeasure what, const ColorScale& scale, ColorMap map);
/// At least where an open upper end lies: what is less is rounding, or an overlap of a millionth of the largest body
/// that moves, and no picture.
inline constexpr double kLeastShown = 1e-12;
double least_shown(const StepRecord& record, ContactMeasure what);

/// How fast its two points slide along each other at the end of the frame, m/s.
double slip_speed(const StepRecord& record, const ContactRecord& contact);

}  // namespace impinge
