// What `taktwerk drive save` keeps goes back: for each of the five drives, on the simulated bus or line of the machine with all of them. Saved,
// compared, changed, restored, compared, all while one drive stays switched on.

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/drive/access.hpp"
#include "apps/drive/drive.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Values = std::vector<config::ParameterSet::Value>;

struct Drive {
    const char* word;
    int axis = 1;
};

/// As `taktwerk drive ... --machine five-drives.yaml --simulate` gets it.
void with(const Drive& drive, const std::function<void(DriveAccess&)>& work) {
    DriveOptions options;
    options.bus = std::make_shared<BusOptions>();
    options.bus->machine = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/five-drives.yaml";
    options.bus->simulate = true;
    options.drive = drive.word;
    options.axis = drive.axis;
    bool worked = false;
    EXPECT_EQ(with_drive(options,
                         [&](DriveAccess& access) {
                             work(access);
                             worked = true;
                             return static_cast<int>(exit_ok);
                         }),
              exit_ok);
    EXPECT_TRUE(worked);
}

/// As `restore` and `diff` read the file.
config::ParameterSet read_back(const KeptSettings& kept, const axes::DriveProfile& profile) {
    const auto read = config::parse_parameter_set("set.yaml", text_of(kept), profile);
    if (const auto* errors = std::get_if<std::vector<Error>>(&read)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    return std::get<config::ParameterSet>(read);
}

/// Within the manual's range, and another than `raw`.
std::int64_t another(const axes::DriveParameter& parameter, std::int64_t raw) {
    const auto low = parameter.minimum.value_or(0), high = parameter.maximum.value_or(1);
    return raw != low ? low : std::min(high, low + 1);
}

class SavedSettings : public ::testing::TestWithParam<Drive> {};

TEST_P(SavedSettings, GoBackWhateverWasChanged) {
    with(GetParam(), [](DriveAccess& drive) {
        for (const auto kept_as : {Kept::unlike_factory, Kept::all}) {
            const auto kept = kept_settings(drive, kept_as);
            ASSERT_TRUE(kept) << kept.error().text();
            ASSERT_THAT(kept->set.values, Not(IsEmpty()));
            const auto set = read_back(*kept, drive.profile());
            ASSERT_EQ(set.values.size(), kept->set.values.size());
            auto difference = difference_from(drive, set);
            ASSERT_TRUE(difference) << difference.error().text();
            EXPECT_THAT(difference->changes, IsEmpty()) << "as saved";
            EXPECT_THAT(difference->left_out, IsEmpty()) << "as saved";

            // A drive does not take every value in every state; what it takes is enough.
            const bool stores = drive.profile().storage.way == axes::ParameterStorage::each_write ||
                                drive.profile().storage.way == axes::ParameterStorage::on_request;
            std::size_t changed = 0;
            for (const auto& value : set.values) {
                if (!stores && value.parameter->waits_for_restart()) continue;  // `restore` refuses what would never count (TSVM-D6)
                const auto other = another(*value.parameter, value.raw);
                if (other == value.raw || !drive.write(*value.parameter, other, Storing::asked)) continue;
                const auto now = drive.read(*value.parameter);
                if (now && *now == other) ++changed;
            }
            EXPECT_GE(changed, 1u);
            difference = difference_from(drive, set);
            ASSERT_TRUE(difference) << difference.error().text();
            EXPECT_EQ(difference->changes.size(), changed) << "diff sees them";

            const auto written = write_values(drive, set.values, stores ? Storing::asked : Storing::volatile_only);
            ASSERT_FALSE(written.error) << written.error->text();
            EXPECT_EQ(written.changes.size(), changed);
            const auto tells_restart = [](const std::string& note) { return note.find("next restart") != std::string::npos; };
            EXPECT_LE(std::count_if(written.notes.begin(), written.notes.end(), tells_restart), 1) << "one line, not one for each";
            difference = difference_from(drive, set);
            ASSERT_TRUE(difference) << difference.error().text();
            EXPECT_THAT(difference->changes, IsEmpty()) << "as restored";
        }
    });
}

/// Nothing is lost in silence: each setting is in the set, or is as the manual says that it left the factory, or is left out and said why.
TEST_P(SavedSettings, AreAllThatTheDriveHas) {
    with(GetParam(), [](DriveAccess& drive) {
        const auto kept = kept_settings(drive, Kept::unlike_factory);
        ASSERT_TRUE(kept) << kept.error().text();
        std::set<const axes::DriveParameter*> seen;
        for (const auto& value : kept->set.values) EXPECT_TRUE(seen.insert(value.parameter).second);
        for (const auto& out : kept->left_out) {
            EXPECT_TRUE(seen.insert(out.parameter).second) << axes::name_of(*out.parameter);
            EXPECT_FALSE(out.why.empty()) << axes::name_of(*out.parameter);
            EXPECT_THAT(text_of(*kept), HasSubstr("# " + axes::name_of(*out.parameter) + " ("));
        }
        for (const auto& parameter : drive.profile().parameters) {
            if (!axes::is_setting(parameter) || seen.count(&parameter) > 0) continue;
            const auto raw = drive.read(parameter);
            ASSERT_TRUE(raw) << raw.error().text();
            EXPECT_TRUE(parameter.is_stated_factory(*raw)) << axes::name_of(parameter);
        }
    });
}

INSTANTIATE_TEST_SUITE_P(FiveDrives, SavedSettings,
                         ::testing::Values(Drive{"sv33_drive"}, Drive{"da200_drive"}, Drive{"robot"}, Drive{"robot", 6},
                                           Drive{"stepper_drive"}, Drive{"xp200_drive"}),
                         [](const auto& one) { return std::string(one.param.word) + "_" + std::to_string(one.param.axis); });

std::vector<std::string> names_of(const std::vector<LeftOut>& left_out) {
    std::vector<std::string> out;
    for (const auto& one : left_out) out.push_back(axes::name_of(*one.parameter));
    return out;
}

// SE-808X 4.4 prints ranges from 1 and no factory value for these eight: as delivered they read 0. 3.2.7: 6098h can be written only.
TEST(SettingsLeftOut, AreThoseThatTheManualDoesNotAllowOrTheDriveDoesNotTell) {
    with({"stepper_drive"}, [](DriveAccess& drive) {
        const auto kept = kept_settings(drive, Kept::all);
        ASSERT_TRUE(kept) << kept.error().text();
        EXPECT_THAT(names_of(kept->left_out), ::testing::UnorderedElementsAre("6098h", "2000h:07", "2000h:08", "2000h:09", "2000h:0A",
                                                                              "2000h:0D", "2000h:0E", "2000h:10", "2000h:12"));
        const auto text = text_of(*kept);
        EXPECT_THAT(text, HasSubstr("# 2000h:07 (inductance) is left out: the drive shows 0 mH, its manual allows 1 .. 65535 mH"));
        EXPECT_THAT(text, HasSubstr("# 6098h (homing method) is left out: reading 6098h:00 was refused: abort 06010001h"));

        // A user writes the method down by hand: it is restored, and nobody can compare it.
        const auto method = axes::find_parameter(drive.profile(), "6098h");
        ASSERT_TRUE(method);
        config::ParameterSet by_hand{"se-808x", "", {{*method, 17}}};
        EXPECT_FALSE(write_values(drive, by_hand.values, Storing::volatile_only).error);
        const auto difference = difference_from(drive, by_hand);
        ASSERT_TRUE(difference) << difference.error().text();
        EXPECT_EQ(names_of(difference->left_out), std::vector<std::string>{"6098h"});
        const auto factory = difference_from_factory(drive);
        ASSERT_TRUE(factory) << factory.error().text();
        EXPECT_EQ(names_of(factory->left_out), std::vector<std::string>{"6098h"}) << "its factory value is stated: 20";
    });
}

// SV-DA200 4.4 and XP200 5.1 list commands among the parameters: a set from one drive that enables, moves, saves or clears the next one when it is
// restored would be a trap. (Named here as in the manuals: saving, restoring, clearing turns and records, tuning, enabling, commands of the
// bus, triggers, the tunnel to any other object, what a probe latched; forced enabling and forced inputs.)
TEST(SettingsLeftOut, ACommandIsNoSetting) {
    const auto keeps = [](const Drive& which, const std::vector<std::string>& commands, const std::string& a_setting) {
        with(which, [&](DriveAccess& drive) {
            const auto kept = kept_settings(drive, Kept::all);
            ASSERT_TRUE(kept) << kept.error().text();
            std::vector<std::string> names;
            for (const auto& value : kept->set.values) names.push_back(axes::name_of(*value.parameter));
            for (const auto& command : commands) {
                EXPECT_TRUE(axes::find_parameter(drive.profile(), command)) << command;
                EXPECT_THAT(names, Not(Contains(command)));
            }
            EXPECT_THAT(names, Contains(a_setting));
        });
    };
    keeps({"da200_drive"}, {"4002h", "4003h", "P0.04", "P0.71", "P1.04", "P4.11", "P4.12",    "P4.13",    "P4.14",
                            "P4.15", "P4.20", "P4.22", "P4.23", "P4.90", "P4.91", "P4.92",    "P4.93",    "P4.94",
                            "P4.95", "P4.96", "P4.97", "P4.99", "P5.15", "P5.20", "4300h:01", "4300h:02", "4020h"},
          "P5.14");
    keeps({"xp200_drive"}, {"Pr098", "Pr119", "Pr120", "Pr121", "Pr122", "Pr123", "Pr124"}, "Pr136");
}

// SV33-E table 6-22: 5FFEh fills a byte of the process data, and sets nothing.
TEST(SettingsLeftOut, AFillerIsNoSetting) {
    with({"sv33_drive"}, [](DriveAccess& drive) {
        const auto kept = kept_settings(drive, Kept::all);
        ASSERT_TRUE(kept) << kept.error().text();
        EXPECT_THAT(text_of(*kept), Not(HasSubstr("5FFEh")));
        EXPECT_THAT(kept->left_out, IsEmpty());
    });
}

}  // namespace
}  // namespace taktwerk::apps
