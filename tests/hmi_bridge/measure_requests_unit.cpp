// Measuring over the socket: the path before, the refusals in words, the result.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "axes/excitation/excitation.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::FakeMachine;
using testing::AllOf;
using testing::HasSubstr;

class MeasureRequests : public testing::Test {
protected:
    MeasureRequests() {
        gateway.observe(true);
        requests.observe(&machine.snapshot);
        requests.on_open(1, {100, 1000, 1000});
        auto& limits = machine.its_config.limits;
        limits.velocity = 200, limits.acceleration = limits.deceleration = 5000, limits.jerk = 100000;
        limits.position_min = 0, limits.position_max = 800;
        machine.its_config.name = "x";
        auto& view = machine.snapshot.axes[0];
        view.set_position = 790, view.manual_slow = 20, view.manual_fast = 50;
    }
    json ask(std::string_view line) {
        requests.on_line(1, line, now);
        gateway.step(now);
        while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
        const auto answer = requests.next_line();
        EXPECT_TRUE(answer.has_value()) << line;
        return answer ? json::parse(answer->text, nullptr, false) : json::object();
    }
    FakeMachine machine;
    Gateway gateway{machine};
    JsonRequests requests{gateway, machine, [] { return 0; }};
    Instant now{10s};
};

TEST_F(MeasureRequests, ThePathIsToldBeforeItIsDriven) {
    const auto plan = ask(R"({"cmd":"measure_plan","axis":"x","kind":"step","distance":-20,"velocity":1000})")["measure_plan"];
    EXPECT_EQ(plan["lowest"], 770);
    EXPECT_EQ(plan["highest"], 790);
    EXPECT_EQ(plan["velocity"], 45) << "nine tenths of what manual mode allows";
    EXPECT_GT(plan["duration_s"], 1);
    EXPECT_TRUE(machine.submitted.empty()) << "nothing moves";
}

TEST_F(MeasureRequests, APathBeyondALimitIsRefusedInWordsBeforeItReachesTheCycle) {
    const auto answer = ask(R"({"id":1,"cmd":"measure","axis":"x","press":true,"kind":"step","distance":20})");
    EXPECT_EQ(answer["ok"], false);
    EXPECT_EQ(answer["error"]["code"], "measure.refused");
    EXPECT_EQ(answer["error"]["subject"], "axis x");
    EXPECT_THAT(answer["error"]["what"].get<std::string>(),
                AllOf(HasSubstr("810"), HasSubstr("upper software limit 800 mm"), HasSubstr("leaves 10 mm")));
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(MeasureRequests, WhatIsWrongIsSaid) {
    const auto code = [&](std::string_view line) { return ask(line)["error"]["code"].get<std::string>(); };
    EXPECT_EQ(code(R"({"cmd":"measure_plan","axis":"x","kind":"steep"})"), "measure.refused");
    EXPECT_EQ(code(R"({"cmd":"measure_plan","axis":"x"})"), "request.missing_key");
    EXPECT_EQ(code(R"({"cmd":"measure_plan","axis":"z9","kind":"step"})"), "command.unknown_name");
    EXPECT_EQ(code(R"({"cmd":"measure_plan","axis":"x","kind":"step","velcoity":3})"), "request.unknown_key");
    EXPECT_EQ(code(R"({"cmd":"measure_result","axis":"x"})"), "measure.none");
    EXPECT_EQ(code(R"({"id":3,"cmd":"measure","axis":"x","press":true,"kind":"step","distance":"far"})"), "request.wrong_type");
}

/// Samples of a whole run as the cycle hands them on: each set-point a millisecond behind, by 0.01 s times the velocity too late.
void play(FakeMachine& machine, const axes::MeasureOrder& order) {
    axes::ExcitationBounds bounds{.start = 400, .velocity = 200, .usual_velocity = 20, .acceleration = 5000, .stop = 5000, .jerk = 100000};
    bounds.revolution = 10, bounds.cycle = 1e-3;
    const axes::ExcitationPlan plan(order, bounds);
    axes::Excitation excitation(plan);
    axes::MotionState next, before{400, 0, 0};
    axes::MeasureSample sample;
    sample.run = 1, sample.fresh = true, sample.cycle = 500;
    for (bool on = true; on;) {
        on = excitation.step(next);
        ++sample.cycle;
        sample.leg = static_cast<std::uint16_t>(excitation.leg()), sample.holds = excitation.holds();
        sample.set_position = next.position, sample.set_velocity = next.velocity, sample.set_acceleration = next.acceleration;
        sample.following_error = 0.01 * before.velocity, sample.actual_position = before.position - sample.following_error;
        machine.samples.push_back(sample);
        before = next;
    }
    machine.snapshot.measure = {1, 0, false, runtime::MeasureEnd::done, axes::ErrorId::none, 1, 0, plan};
}

TEST_F(MeasureRequests, TheResultHasNumbersAndBoundedCurves) {
    axes::MeasureOrder order{axes::MeasureKind::ramp};
    order.distance = 100, order.velocity = 50;
    play(machine, order);
    requests.step(now);
    const auto result = ask(R"({"cmd":"measure_result","axis":"x","window":0.05})")["measure_result"];
    EXPECT_EQ(result["end"], "done");
    EXPECT_EQ(result["kind"], "ramp");
    EXPECT_EQ(result["doubt"], "");
    EXPECT_NEAR(result["lag_s"].get<double>(), 0.01, 1e-5);
    EXPECT_NEAR(result["dead_time_s"].get<double>(), 1e-3, 1e-5);
    EXPECT_NEAR(result["error_at_velocity"]["value"].get<double>(), 0.5, 1e-3);
    ASSERT_EQ(result["curves"].size(), 2u);
    const auto& curve = result["curves"][0];
    EXPECT_GT(curve["time_s"].size(), 300u);
    EXPECT_LE(curve["time_s"].size(), 800u);
    EXPECT_EQ(curve["time_s"].size(), curve["actual_position"].size());
    EXPECT_EQ(ask(R"({"cmd":"state"})")["state"]["measure"]["run"], 1);
}

// Five minutes at 250 us are 1.2 million samples: two such runs are more than is kept of all axes together, and the older one goes.
TEST_F(MeasureRequests, OlderRunsMakeRoomForNewerOnes) {
    axes::ExcitationBounds bounds{.start = 400, .velocity = 200, .usual_velocity = 20, .acceleration = 5000, .stop = 5000, .jerk = 100000};
    bounds.cycle = 250e-6;
    axes::MeasureOrder order{axes::MeasureKind::ramp};
    order.distance = 290, order.velocity = 20, order.count = 10;
    const axes::ExcitationPlan plan(order, bounds);
    ASSERT_GT(plan.duration(), 250);
    for (std::uint16_t axis = 0; axis < 2; ++axis) {
        const auto run = static_cast<std::uint32_t>(axis + 1);
        for (std::uint64_t cycle = 1; cycle <= 30; ++cycle) {
            axes::MeasureSample sample;
            sample.run = run, sample.cycle = cycle, sample.fresh = true;
            machine.samples.push_back(sample);
        }
        machine.snapshot.measure = {run, axis, false, runtime::MeasureEnd::stopped, axes::ErrorId::none, 1, 0, plan};
        requests.step(now);
        const auto& name = machine.layout().axes[axis].name;
        EXPECT_EQ(ask(R"({"cmd":"measure_result","axis":")" + name + R"("})")["measure_result"]["samples"], 30);
    }
    const auto gone = ask(R"({"cmd":"measure_result","axis":"x"})");
    EXPECT_EQ(gone["error"]["code"], "measure.forgotten") << gone;
}

TEST_F(MeasureRequests, AnOverrideOfNothingIsToldBeforeAnythingMoves) {
    machine.snapshot.axes[0].operators_override = 0;
    const auto answer = ask(R"({"cmd":"measure_plan","axis":"x","kind":"step"})");
    EXPECT_EQ(answer["error"]["code"], "measure.refused");
    EXPECT_THAT(answer["error"]["what"].get<std::string>(), HasSubstr("override"));
    machine.snapshot.axes[0].operators_override = 0.5;
    EXPECT_EQ(ask(R"({"cmd":"measure_plan","axis":"x","kind":"step","distance":-20,"velocity":1000})")["measure_plan"]["velocity"], 22.5);
}

TEST_F(MeasureRequests, EveryKindHasAResult) {
    for (const auto kind : {axes::MeasureKind::step, axes::MeasureKind::friction, axes::MeasureKind::following, axes::MeasureKind::sweep,
                            axes::MeasureKind::cogging}) {
        machine.samples.clear();
        axes::MeasureOrder order{kind};
        if (kind != axes::MeasureKind::sweep) order.distance = 40;
        play(machine, order);
        for (auto& sample : machine.samples) sample.run = static_cast<std::uint32_t>(kind) + 10;
        machine.snapshot.measure.run = static_cast<std::uint32_t>(kind) + 10;
        requests.step(now);
        const auto result = ask(R"({"cmd":"measure_result","axis":"x"})")["measure_result"];
        EXPECT_EQ(result["kind"], std::string(name(kind)));
        EXPECT_TRUE(result.contains("doubt")) << name(kind);
        EXPECT_FALSE(result["curves"].empty()) << name(kind);
        for (const auto& curve : result["curves"])
            for (const auto& list : curve)
                if (list.is_array()) {
                    EXPECT_LE(list.size(), 800u);
                }
    }
}

}  // namespace
}  // namespace taktwerk::hmi
