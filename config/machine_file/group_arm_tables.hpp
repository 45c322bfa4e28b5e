#pragma once
// `kinematics:` of a group: one key a kind of arm, where it is mounted, how its members count their joints.

#include "config/machine_file/group_arm.hpp"
#include "config/reading/field_table.hpp"

namespace taktwerk::config {

/// Error: config.group_arm (no kind, or several; a table of other than six rows).
[[nodiscard]] Table<ArmEntry> arm_table();

/// `kinematics: scara`, or `kind: scara` in it: the kind is a key. false: that word is no kind.
bool report_arm_word(Reader& reader, const Node& word);

}  // namespace taktwerk::config
