// Hands on a simulated machine: understood and checked at once, done on the thread that plays the machine.

#include "apps/machine/sim_hands.hpp"

#include <gtest/gtest.h>

#include "tests/machines/plain_machine.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

struct SimHandsTest : ::testing::Test {
    runtime::MachineConfig config = runtime::testing::machine_config(1);
    Instant now = Instant{} + 1s;
    runtime::World world{config, now};
    SimHands hands{world, config};
    std::string code(const std::string& line) {
        const auto asked = hands.ask(line);
        if (asked) return "";
        EXPECT_FALSE(asked.error().remedy.empty()) << line;
        return asked.error().code;
    }
};

TEST_F(SimHandsTest, AButtonIsPressedByTheNextStepAndNotBefore) {
    world.drive("x")->main_power(true);
    EXPECT_EQ(code("jam x"), "");
    EXPECT_EQ(code("unplug x_drive"), "");
    EXPECT_EQ(hands.next_event(), Instant::max());
    const auto plugged = [&] { return world.network().slave(0).powered(); };
    EXPECT_TRUE(plugged());
    EXPECT_EQ(code("power-off x_drive"), "");
    EXPECT_TRUE(plugged()) << "the asking thread touches nothing";
    hands.step(now);
    EXPECT_FALSE(plugged());
}

TEST_F(SimHandsTest, LaterIsCountedFromTheStepThatTookIt) {
    EXPECT_EQ(code("after 2s power-off x_drive"), "");
    hands.step(now);
    EXPECT_EQ(hands.next_event(), now + 2s);
    hands.step(now + 1999ms);
    EXPECT_TRUE(world.network().slave(0).powered());
    hands.step(now + 2s);
    EXPECT_FALSE(world.network().slave(0).powered());
}

TEST_F(SimHandsTest, TheCableOfTheSecondInterfaceIsPulledWhereThereIsOne) {
    EXPECT_EQ(code("unplug ring"), "fault.no_slave");
    config.bus.ring = ecat::RingConfig{};
    runtime::World ring{config, now};
    SimHands pulling{ring, config};
    EXPECT_TRUE(pulling.ask("unplug ring"));
    pulling.step(now);
    std::array<std::byte, ecat::min_frame_size> frame{};
    EXPECT_TRUE(ring.network().process(frame, now));
    EXPECT_FALSE(ring.network().came_out_elsewhere()) << "comes back to where it left";
}

TEST_F(SimHandsTest, WhatIsWrongIsSaidToWhoAsks) {
    EXPECT_EQ(code("inpt button 1"), "fault.unknown");
    EXPECT_EQ(hands.ask("inpt button 1").error().remedy, "did you mean 'input'?");
    EXPECT_EQ(code("input button"), "fault.arguments");
    EXPECT_EQ(code("input buton 1"), "fault.no_target");
    EXPECT_EQ(code("drive-fault x 0"), "fault.arguments");
    EXPECT_EQ(code("unplug y_drive"), "fault.no_slave");
    EXPECT_EQ(hands.ask("unplug x_driv").error().remedy, "did you mean 'x_drive'?");
    EXPECT_EQ(code("unplug master"), "");
    EXPECT_EQ(code(""), "fault.unknown");
    EXPECT_EQ(code("corrupt 1 12111"), "");
    EXPECT_EQ(code("corrupt 1 12112"), "fault.arguments") << "no frame is longer than 1514 bytes";
    EXPECT_EQ(code("corrupt 1 999999999"), "fault.arguments");
}

TEST_F(SimHandsTest, AButtonIsPressedOrNotAndNothingElse) {
    EXPECT_EQ(code("input button 1"), "");
    EXPECT_EQ(code("input button 0"), "");
    EXPECT_EQ(code("input button 2"), "fault.arguments");
    EXPECT_EQ(code("input button -1"), "fault.arguments");
    EXPECT_EQ(code("after 1s input button 2"), "fault.arguments") << "not in a second, when nobody hears it";
}

TEST_F(SimHandsTest, WhatComesInAgesIsRefused) {
    EXPECT_EQ(code("after 1000000s jam x"), "");
    for (const std::string wait : {"8888888888888882s", "1e300s", "1000001s", "-1s", "nan"})
        EXPECT_EQ(code("after " + wait + " jam x"), "fault.arguments") << wait;
}

TEST_F(SimHandsTest, AnInputWithAUnitTakesItWrittenAsPeopleWriteIt) {
    for (auto& point : config.io)
        if (point.name == "button") point.unit = "bar", point.line.factor = 0.5;
    const auto value = [&](const std::string& line) {
        const auto event = parse_happening(line, config);
        return event ? event->value : -1;
    };
    EXPECT_EQ(value("input button 4bar"), 8);
    EXPECT_EQ(value("input button 4 bar"), 8);
    EXPECT_EQ(value("input button 4"), 8);
    for (const std::string wrong : {"input button 4 mm", "input button bar", "input button nan", "input button 4 bar 5"})
        EXPECT_EQ(parse_happening(wrong, config).error().code, "fault.arguments") << wrong;
    const auto asked = parse_happening("input button 4mm", config);
    ASSERT_FALSE(asked);
    EXPECT_NE(asked.error().text().find("bar"), std::string::npos) << "in which unit it is: " << asked.error().text();
    EXPECT_NE(asked.error().text().find("4mm"), std::string::npos);
}

TEST_F(SimHandsTest, EveryWordOfTheListIsUnderstood) {
    for (const auto& word : sim_words()) {
        if (word.word == "after") continue;
        EXPECT_NE(code(std::string(word.word)), "fault.unknown") << word.word;
    }
}

}  // namespace
}  // namespace taktwerk::apps
