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

}  // namespace
}  // namespace taktwerk::hmi
