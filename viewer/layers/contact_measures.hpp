// What a contact shows beside its state, for colours, sizes and tables.
#pragma once

#include "engine/world/step_record.hpp"
#include "viewer/draw/draw_list.hpp"

namespace impinge {

enum class ContactMeasure { overlap, impulse, slip };

/// How deep the bodies overlap there, m; the normal impulse, N s; how fast the two points slide along each other, m/s.
double measure_of(const StepRecord& record, const ContactRecord& contact, ContactMeasure what);

/// Its colours, with numbers in the prefix that the end has few figures in.
ColorBar bar_of(ContactMeasure what, double high, bool exceeded);
/// Where colours end: what the setting says; at 0 what the frame has, rounded up.
double bar_end(double setting, double most);

/// The least of 1, 2 and 5 times a power of ten that is not below a positive value.
double rounded_up(double value);

/// How fast its two points slide along each other at the end of the frame, m/s.
double slip_speed(const StepRecord& record, const ContactRecord& contact);

}  // namespace impinge
