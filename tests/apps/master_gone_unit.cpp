// What `taktwerk check` says that a drive does alone, against the drives' manuals: never what CiA 402 says of another one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/machine/master_gone.hpp"
#include "config/machine_file/machine_loader.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> said(const std::string& profile, const std::string& startup, const std::string& more = {}) {
    const std::string text =
        "version: 1\nname: gone\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n    - name: drive\n      profile: " + profile +
        "\n" + (startup.empty() ? "" : "      startup: [" + startup + "]\n") +
        "axes:\n  x:\n    slave: drive\n    unit: mm\n    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
        "    limits: { velocity: 20 mm/s, acceleration: 100 mm/s2, jerk: 1000 mm/s3 }\n" +
        more;
    config::LoadOptions options;
    options.simulate = true;
    auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/gone.yaml", text, options);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    const auto& machine = std::get<config::LoadedMachine>(loaded).machine;
    return master_gone(machine, machine.axes.front());
}

// 3.2.1: stays in Quick Stop Active until Disable voltage or Enable operation. 4.3: 605Eh = 0, "current off, the motor is released".
TEST(MasterGone, AnSe808xStaysEnergisedAfterAQuickStopAndIsFreeAtAFault) {
    const auto sentences = said("se-808x", "{ object: 605Ah, value: 2 }");
    EXPECT_THAT(sentences,
                Contains(AllOf(HasSubstr("at a quick stop (605Ah) = 2: it brakes along 6085h, then it stays energised and holds"))));
    EXPECT_THAT(sentences, Contains(HasSubstr("at a fault (605Eh) = 0: the power goes off, the motor coasts [the factory's value")));
    EXPECT_THAT(said("se-808x", ""), Contains(AllOf(HasSubstr("605Ah) = 1"), HasSubstr("assumed, its manual prints none"))));
}

// Table 3-17: in CSP 605Ah = 2 brakes with the torque of P04.23; 3.1.8: P04.11 = 2 at a fault.
TEST(MasterGone, AnSv33EInCspBrakesWithP0423NotAlong6085h) {
    const auto sentences = said("sv33-e", "");
    EXPECT_THAT(sentences,
                Contains(HasSubstr("at a quick stop (605Ah) = 2: it brakes at once with the torque of P04.23, not along a ramp, then the "
                                   "power goes off [the factory's value")));
    EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("at a fault (P04.11) = 2"), HasSubstr("the windings stay shorted"))));
    EXPECT_THAT(said("sv33-e", "", "    control: { mode: velocity, kv: 10 }\n"), Contains(HasSubstr("605Ah) = 2: it brakes along 6085h")))
        << "in CSV the ramp counts";
}

// 3.2.7: 0Bh is "emergency stop, speed mode, zero-speed clamp"; there is no 605Ah. P4.30 exists without its values.
TEST(MasterGone, AnSvDa200ClampsAtSpeed0) {
    const auto sentences = said("sv-da200", "");
    EXPECT_THAT(sentences,
                Contains(HasSubstr("at a quick stop: it brakes at once with all its torque, then it stays energised at speed 0")));
    EXPECT_THAT(sentences, Contains(HasSubstr("at a fault: taken to brake and then go off, its manual does not say how")));
    EXPECT_THAT(sentences, Each(Not(HasSubstr("605Ah"))));
}

// 5.3.1: "605Ah = 0..3" and nothing of what each does; its factory value is not printed.
TEST(MasterGone, OfATsvmNothingIsClaimedThatItsManualDoesNotSay) {
    const auto sentences = said("tsvm-d6", "", "    axis: 1\n");
    EXPECT_THAT(sentences, Contains(HasSubstr("at a quick stop: its manual does not say what the values of 605Ah do")));
    EXPECT_THAT(sentences, Contains(HasSubstr("at a fault: taken to coast, its manual does not say")));
}

}  // namespace
}  // namespace taktwerk::apps
