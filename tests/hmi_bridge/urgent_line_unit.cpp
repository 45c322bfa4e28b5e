// Lines with more keys than any command has, at the door: each key would be compared with all before it, and behind the line a stop waits.
#include <gtest/gtest.h>

#include "hmi_bridge/socket/urgent_line.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

std::optional<UrgentLine> with_keys(std::string line, int more) {
    static const test::FakeMachine machine;
    for (int key = 0; key < more; ++key) line += ",\"" + std::to_string(key) + "\":1";
    return urgent_line(line + "}", machine.layout());
}

TEST(UrgentLines, AStopWithTooManyKeysStopsAll) {
    for (const char* stop : {R"({"cmd":"stop","axis":"y")", R"({"c\u006dd":"stop","axis":"y")"}) {
        const auto few = with_keys(stop, 62);
        ASSERT_TRUE(few) << stop;
        EXPECT_EQ(few->axis, 1);
        EXPECT_FALSE(few->unclear);
        const auto many = with_keys(stop, 63);
        ASSERT_TRUE(many) << stop;
        EXPECT_EQ(many->axis, 0xFFFF);
        EXPECT_TRUE(many->unclear) << "and is refused";
    }
}

TEST(UrgentLines, NothingElseWithTooManyKeysActsAtOnce) {
    ASSERT_TRUE(with_keys(R"({"cmd":"shutdown")", 63));
    EXPECT_FALSE(with_keys(R"({"cmd":"shutdown")", 64));
    EXPECT_FALSE(with_keys(R"({"cmd":"shutdown")", 7000));
    ASSERT_TRUE(with_keys(R"({"cmd":"jog","axis":"x","velocity":1)", 61));
    EXPECT_FALSE(with_keys(R"({"cmd":"jog","axis":"x","velocity":1)", 62));
}

// A group's jog is held and let go as that of each of its axes ("table" has both); what is no group of this machine is not urgent, and refused behind the door.
TEST(UrgentLines, AJogOfAGroupIsOneOfEachOfItsAxes) {
    const auto press = with_keys(R"({"cmd":"group_jog","group":"table","direction":"x+","velocity":0.5,"press":true)", 0);
    ASSERT_TRUE(press);
    EXPECT_EQ(press->kind, UrgentLine::Kind::jog_hold);
    EXPECT_TRUE(press->press);
    EXPECT_EQ(press->held, (std::vector<std::uint16_t>{0, 1}));
    const auto release = with_keys(R"({"cmd":"group_jog","group":"table","velocity":0)", 0);
    ASSERT_TRUE(release);
    EXPECT_EQ(release->kind, UrgentLine::Kind::jog_release);
    EXPECT_EQ(release->held, (std::vector<std::uint16_t>{0, 1}));
    EXPECT_FALSE(with_keys(R"({"cmd":"group_jog","group":"tabel","velocity":0)", 0));
    EXPECT_FALSE(with_keys(R"({"cmd":"group_jog","velocity":0)", 0));
    EXPECT_FALSE(with_keys(R"({"cmd":"group_jog","group":["table"],"velocity":0)", 0));
}

}  // namespace
}  // namespace taktwerk::hmi
