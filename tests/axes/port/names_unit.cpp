#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "axes/port/drive_port.hpp"
#include "axes/port/drive_profile.hpp"
#include "axes/port/quirk.hpp"

namespace taktwerk::axes {
namespace {

// Every enumerator has words of its own: none falls through to "?".
TEST(DrivePortNames, EveryModeAndStateHasOne) {
    for (int i = 0; i <= static_cast<int>(DriveMode::cyclic_torque); ++i) EXPECT_NE(name(static_cast<DriveMode>(i)), "?") << i;
    for (int i = 0; i <= static_cast<int>(PowerState::fault); ++i) EXPECT_NE(name(static_cast<PowerState>(i)), "?") << i;
    EXPECT_EQ(name(PowerState::enabled), "operation enabled");
    EXPECT_EQ(name(static_cast<DriveMode>(200)), "?");
}

TEST(DriveCapabilities, ModesAreBits) {
    DriveCapabilities caps;
    caps.modes = (1u << static_cast<unsigned>(DriveMode::homing)) | (1u << static_cast<unsigned>(DriveMode::cyclic_position));
    EXPECT_TRUE(caps.has(DriveMode::homing));
    EXPECT_FALSE(caps.has(DriveMode::cyclic_torque));
}

TEST(DriveProfile, KnowsItsQuirks) {
    DriveProfile profile;
    profile.quirks = {Quirk::no_remote_bit};
    EXPECT_TRUE(profile.has(Quirk::no_remote_bit));
    EXPECT_FALSE(profile.has(Quirk::disable_may_coast));
}

TEST(QuirkTable, NamesAndExplainsAQuirkOnce) {
    std::set<std::string_view> names;
    for (const auto& row : quirk_table) {
        EXPECT_EQ(find_quirk(row.quirk), &row) << row.name;
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.doc.empty()) << row.name;
    }
}

}  // namespace
}  // namespace taktwerk::axes
