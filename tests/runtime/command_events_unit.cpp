// The list of refused and aborted commands: short, without floods, and honest about what it left out.

#include "runtime/command_events.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;

CommandEvent event(std::uint16_t axis, std::uint16_t program = 0) {
    CommandEvent out;
    out.axis = axis;
    out.given.kind = axes::CommandKind::move_absolute;
    out.given.program = program;
    out.error = axes::ErrorId::state_forbids;
    return out;
}
const Instant start = Instant{} + 100s;

// A block that is told no and asks again each millisecond is one event, news again only after the quiet time.
TEST(CommandEvents, TheSameEventIsCountedNotRepeated) {
    CommandEvents list;
    for (int i = 0; i < 20'000; ++i) list.note(event(1), start + i * 1ms);
    ASSERT_EQ(list.events().size(), 1u);
    EXPECT_EQ(list.events()[0].times, 20'000u);
    EXPECT_EQ(list.events()[0].number, 1u);
    EXPECT_EQ(list.events()[0].at, start);

    list.note(event(1), start + CommandEvents::quiet);
    ASSERT_EQ(list.events().size(), 1u);
    EXPECT_EQ(list.events()[0].number, 2u);
    EXPECT_EQ(list.events()[0].times, 1u);
    EXPECT_EQ(list.dropped(), 0u);
}

TEST(CommandEvents, AnotherAxisOrBlockOrReasonIsAnotherEvent) {
    CommandEvents list;
    list.note(event(1), start);
    list.note(event(2), start);
    list.note(event(1, 7), start);
    auto other = event(1);
    other.error = axes::ErrorId::not_powered;
    list.note(other, start);
    other.held = true;
    list.note(other, start);
    EXPECT_EQ(list.events().size(), 5u);
    EXPECT_EQ(list.events().back().number, 5u);
}

TEST(CommandEvents, MoreThanTheListHoldsLosesTheOldestAndTheNumbersSayIt) {
    CommandEvents list;
    for (std::uint16_t i = 0; i < 40; ++i) list.note(event(i), start + i * 1s);
    ASSERT_EQ(list.events().size(), CommandEvents::capacity);
    EXPECT_EQ(list.events().front().number, 9u);
    EXPECT_EQ(list.events().back().number, 40u);
    EXPECT_EQ(list.dropped(), 0u);
}

TEST(CommandEvents, AFloodOfDifferentOnesIsBoundedAndCounted) {
    CommandEvents list;
    for (std::uint16_t i = 0; i < 100; ++i) list.note(event(i), start);
    EXPECT_EQ(list.events().size(), CommandEvents::most_a_second);
    EXPECT_EQ(list.dropped(), 100u - CommandEvents::most_a_second);
    list.note(event(200), start + 1s);
    EXPECT_EQ(list.events().back().axis, 200) << "a second later there is room";
}

TEST(CommandEvents, EachChangeShowsInTheRevision) {
    CommandEvents list;
    auto before = list.revision();
    for (std::uint16_t i = 0; i < 60; ++i) {  // new ones, repeated ones, dropped ones
        list.note(event(i / 2), start);
        EXPECT_NE(list.revision(), before);
        before = list.revision();
    }
}

}  // namespace
}  // namespace taktwerk::runtime
