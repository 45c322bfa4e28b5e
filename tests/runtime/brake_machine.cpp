// A holding brake on an output of the machine, over real frames: it follows the power, whatever a person writes there, and power waits for it.

#include "runtime/check/machine_check.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;
using axes::BrakeState;

struct OutputBrake : ::testing::Test {
    OutputBrake() : m(config()) {}
    static MachineConfig config() {
        auto config = machine_config(1);
        auto& x = config.axes[0];
        x.axis.brake = {.by = axes::BrakeBy::output, .release = 80ms, .engage = 120ms};
        x.brake_output = "lamp";
        return config;
    }
    [[nodiscard]] bool open() { return m.state().outputs.at(0) != 0; }
    TestMachine m;
};

TEST_F(OutputBrake, FollowsThePower) {
    ASSERT_TRUE(m.up());
    EXPECT_FALSE(open());
    bool early = false;
    m.on_cycle = [&] { early = early || (open() && m.axis(0).drive_state != axes::PowerState::enabled); };
    m.enable(0);
    m.on_cycle = {};
    EXPECT_FALSE(early) << "open before the drive held the load";
    EXPECT_TRUE(open());
    EXPECT_EQ(m.axis(0).brake, BrakeState::open);

    Duration held{};
    m.on_cycle = [&] {
        if (!open() && m.axis(0).drive_state == axes::PowerState::enabled) held += 1ms;
    };
    EXPECT_EQ(m.command(OperatorAction::power, 0, false).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).drive_state == axes::PowerState::disabled; }, 1s));
    EXPECT_FALSE(open());
    EXPECT_GE(held, 120ms) << "the drive holds until the brake does";
    EXPECT_LE(held, 140ms);
}

TEST_F(OutputBrake, ClosesAtAFaultAndBelongsToItsAxis) {
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 700, 150).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 140; }, 3s));
    m.world.drive("x")->raise(0x3130);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 100ms));
    ASSERT_TRUE(m.until([&] { return !open(); }, 2s));
    OperatorCommand write;
    write.action = OperatorAction::set_output;
    write.index = 0;
    write.value = 1;
    (void)m.command(write);
    m.run(5ms);
    EXPECT_FALSE(open()) << "the output has one writer";
}

TEST(OutputBrakeCheck, SaysWhatIsWrong) {
    const auto problem_of = [](const std::function<void(MachineConfig&)>& change) {
        auto config = OutputBrake::config();
        change(config);
        const auto errors = check(config);
        return errors.empty() ? std::string{} : errors[0].text();
    };
    EXPECT_EQ(problem_of([](MachineConfig&) {}), "");
    EXPECT_NE(problem_of([](MachineConfig& c) { c.axes[0].brake_output = "lampe"; }).find("did you mean 'lamp'"), std::string::npos);
    EXPECT_NE(problem_of([](MachineConfig& c) { c.axes[0].brake_output.clear(); }).find("nothing says which output"), std::string::npos);
    EXPECT_NE(problem_of([](MachineConfig& c) {
                  for (auto& point : c.io)
                      if (point.name == "lamp") point.safe_value = 1;
              }).find("must be off where nobody drives it"),
              std::string::npos);
    EXPECT_NE(
        problem_of([](MachineConfig& c) { c.axes[0].axis.brake.by = axes::BrakeBy::object; }).find("counts only where `by` is `output`"),
        std::string::npos);
    EXPECT_NE(problem_of([](MachineConfig& c) {
                  c.axes[0].axis.brake.by = axes::BrakeBy::object;
                  c.axes[0].brake_output.clear();
              }).find("has no object that works a brake"),
              std::string::npos);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
