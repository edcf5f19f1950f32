// What the records of a frame and of a stage have in common: bodies and contacts as they are now.
#pragma once

#include "engine/contact/attachments.hpp"
#include "engine/step/group_result.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

/// All but its group.
BodyRecord record_of(const Body& body);
/// Of detection, with the places of the bodies that touch; not solved.
SolvedContact found_contact(const Collision& collision, const Bodies& bodies, const ContactSettings& settings);
/// Its points and its normal carried with their bodies to where these are now.
ContactRecord carried(const SolvedContact& contact, const Bodies& bodies);

/// Where they hold now, in their order, without impulses.
void show_attachments(std::span<const Attachment> attachments, const Bodies& bodies, StepRecord& record);

}  // namespace impinge
