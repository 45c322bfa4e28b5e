// What stands in `state` and `layout`: JSON that any reader takes, numbers to the last bit, the axis as its LCM message has it.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <nlohmann/json.hpp>

#include "axes/axis/parameters.hpp"
#include "hmi_bridge/socket/json_layout.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "hmi_bridge/socket/json_writer.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

Json state_of(const test::FakeMachine& machine) { return Json::parse(state_json(machine.snapshot, machine)); }

TEST(JsonWriter, ObjectsArraysAndKeysAreSeparated) {
    JsonWriter json;
    json.open('{');
    json.field("a", 1);
    json.open("empty", '{');
    json.close('}');
    json.open("list", '[');
    json.value(true);
    json.open('{');
    json.close('}');
    json.value(std::nullopt);
    json.close(']');
    json.name("a \"name\"");
    json.value("x");
    json.close('}');

    EXPECT_EQ(json.take(), R"({"a":1,"empty":{},"list":[true,{},null],"a \"name\"":"x"})");
}

// A text may hold whatever a drive or a file said: it stays one JSON text, and bytes that are no UTF-8 cost only themselves.
TEST(JsonWriter, AnyTextIsOneText) {
    for (const std::string text : {"", "plain", "quote \" back \\ slash", "line\nend\t\x01", "跟随误差过大", "del \x7f"}) {
        JsonWriter json;
        json.value(text);
        EXPECT_EQ(Json::parse(json.take()).get<std::string>(), text);
    }
    JsonWriter json;
    json.value("bad \xff\xc3 end");
    EXPECT_EQ(Json::parse(json.take()).get<std::string>(), "bad \xef\xbf\xbd\xef\xbf\xbd end");
}

TEST(JsonWriter, EveryNumberReadsBackAsItself) {
    std::mt19937_64 random{20261125};
    for (int i = 0; i < 20'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        JsonWriter json;
        json.value(value);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(Json::parse(json.take()).get<double>()), std::bit_cast<std::uint64_t>(value));
    }
    JsonWriter json;
    json.open('[');
    json.value(std::numeric_limits<std::int64_t>::min());
    json.value(std::numeric_limits<std::uint64_t>::max());
    json.value(std::numeric_limits<double>::quiet_NaN());
    json.value(std::numeric_limits<double>::infinity());
    json.value(-std::numeric_limits<double>::infinity());
    json.close(']');
    EXPECT_EQ(json.take(), R"([-9223372036854775808,18446744073709551615,"NaN","Infinity","-Infinity"])");
}

TEST(JsonState, AnAxisHasWhatItsLcmMessageHas) {
    test::FakeMachine machine;
    auto& x = machine.snapshot.axes[0];
    x.set_position = 100;
    x.set_velocity = -20;
    x.target_position = 40;
    x.active = 3;
    x.enable = true;
    x.enable_negative = false;
    x.brake = axes::BrakeState::open;
    x.torque_limit_positive = 0.5;
    x.turns = -3;
    x.master = {1};
    x.parameters[axes::place_of(axes::software_limit_negative)] = -10;
    x.parameters[axes::place_of(axes::enable_limit_negative)] = 1;
    x.parameters[axes::place_of(axes::software_limit_positive)] = 400;
    machine.snapshot.following_peaks = {{-0.75, 0.5}, {}, {}};

    const auto axis = state_of(machine)["axes"][0];

    EXPECT_EQ(axis["distance_to_go"], -60) << "target minus set position";
    EXPECT_EQ(axis["following_error_min"], -0.75);
    EXPECT_EQ(axis["following_error_max"], 0.5);
    EXPECT_EQ(axis["negative_direction"], true);
    EXPECT_EQ(axis["positive_direction"], false);
    EXPECT_EQ(axis["constant_velocity"], true) << "moves, and no acceleration";
    EXPECT_EQ(axis["not_moving"], false);
    EXPECT_EQ(axis["enable"], true);
    EXPECT_EQ(axis["enable_positive"], true);
    EXPECT_EQ(axis["enable_negative"], false);
    EXPECT_EQ(axis["brake"], "open");
    EXPECT_EQ(axis["torque_limit_positive"], 0.5);
    EXPECT_EQ(axis["torque_limit_negative"], "Infinity") << "what the drive has";
    EXPECT_EQ(axis["turns"], -3);
    EXPECT_EQ(axis["master"], "y");
    EXPECT_EQ(axis["position_min"], -10);
    EXPECT_TRUE(axis["position_max"].is_null()) << "not watched";
    EXPECT_EQ(state_of(machine)["axes"][1]["master"], "");
}

TEST(JsonState, TheLayoutSaysWhatLimitsAnAxis) {
    test::FakeMachine machine;
    auto& x = machine.its_layout.axes[0];
    x.position_min = -10;
    x.velocity_limit = 300;
    x.acceleration_limit = 2000;
    x.deceleration = 1500;
    x.in_position_window = 0.02;
    x.following_window = 3;
    x.homing = axes::HomingKind::home_switch;
    machine.its_layout.axes[2].modulo = 360;

    const auto axes = Json::parse(layout_json(machine.its_layout))["axes"];

    EXPECT_EQ(axes[0]["position_min"], -10);
    EXPECT_TRUE(axes[0]["position_max"].is_null()) << "there is none";
    EXPECT_EQ(axes[0]["velocity_limit"], 300);
    EXPECT_EQ(axes[0]["acceleration_limit"], 2000);
    EXPECT_EQ(axes[0]["deceleration"], 1500);
    EXPECT_TRUE(axes[0]["jerk_limit"].is_null()) << "not limited";
    EXPECT_EQ(axes[0]["following_window"], 3);
    EXPECT_EQ(axes[0]["in_position_window"], 0.02);
    EXPECT_EQ(axes[0]["modulo"], 0);
    EXPECT_EQ(axes[0]["homing"], "home_switch");
    EXPECT_EQ(axes[1]["homing"], "none");
    EXPECT_EQ(axes[2]["modulo"], 360);
}

}  // namespace
}  // namespace taktwerk::hmi
