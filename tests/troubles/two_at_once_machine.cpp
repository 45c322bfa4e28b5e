// What the table does not stage: troubles with more than one message, of which none may accuse who is innocent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/troubles/bench.hpp"
#include "tests/troubles/devices.hpp"

namespace taktwerk::troubles {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<Said> heard_after(Bench& bench, void (*strikes)(Bench&)) {
    if (!bench.bring_up()) {
        ADD_FAILURE() << bench.why();
        return {};
    }
    bench.run_for(300ms);
    strikes(bench);
    return bench.what_alarms_say({});
}

std::string place_of(const std::vector<Said>& said, std::string_view id) {
    const auto found = std::find_if(said.begin(), said.end(), [&](const Said& one) { return one.id == id; });
    EXPECT_NE(found, said.end()) << id;
    return found == said.end() ? "" : found->place;
}

// Every other clock is off from one that jumped, by the same: none of them is the one to be replaced.
TEST(TwoAtOnce, OfAReferenceClockThatJumpsItIsTheReferenceThatIsNamed) {
    for (const Duration jump : {Duration{300us}, Duration{-300us}, Duration{10ms}}) {
        Bench bench{"sssst", ""};
        bench.config.slaves[4].dc = false;
        static Duration by{};
        by = jump;
        const auto said = heard_after(bench, [](Bench& b) { b.there('a').controller().step_clock(by, b.now); });
        for (const auto& one : said)
            EXPECT_THAT(one.place, AllOf(HasSubstr("'a'"), Not(HasSubstr("'b'")), Not(HasSubstr("'c'")), Not(HasSubstr("'d'"))));
        EXPECT_THAT(place_of(said, "dc_out_of_sync"), HasSubstr("slave 0 'a' (sv33-e), the reference"));
    }
}

TEST(TwoAtOnce, OfAnotherClockThatJumpsItIsThatOne) {
    Bench bench{"ssss", ""};
    const auto said = heard_after(bench, [](Bench& b) { b.there('c').controller().step_clock(400us, b.now); });
    EXPECT_THAT(place_of(said, "dc_out_of_sync"), AllOf(HasSubstr("most of all slave 2 'c'"), Not(HasSubstr("'b'"))));
}

// This computer stalls, and a slave loses its power meanwhile: who has no power was not starved.
TEST(TwoAtOnce, WhoLostItsPowerIsNotNamedAmongThoseThatThisComputerStarved) {
    Bench bench{"sstss", ""};
    const auto said = heard_after(bench, [](Bench& b) {
        b.network.set_power(b.there('c'), false);
        b.now += 20ms;
        b.network.advance(b.now);
    });
    EXPECT_THAT(place_of(said, "cable_broken"), HasSubstr("between slave 1 'b' (sv33-e) port 1 and slave 2 'c'"));
    EXPECT_THAT(place_of(said, "starved_slave_left_op"), AllOf(Not(HasSubstr("'c'")), Not(HasSubstr("'d'")), Not(HasSubstr("'e'"))));
}

// A ring breaks at a second place: the slaves between the two are not behind the cable that broke first.
TEST(TwoAtOnce, OfARingThatIsBrokenTwiceBothEndsOfWhatIsCutOffAreNamed) {
    for (const bool first_is_in_front : {true, false}) {
        Bench bench{"ststs", ""};
        bench.make_ring();
        ASSERT_TRUE(bench.bring_up()) << bench.why();
        bench.run_for(300ms);
        bench.set_ring_cable(first_is_in_front ? 2 : 4, false);
        bench.run_for(500ms);
        bench.set_ring_cable(first_is_in_front ? 4 : 2, false);
        EXPECT_THAT(place_of(bench.what_alarms_say({}), "cable_broken"),
                    AllOf(HasSubstr("between slave 1 'b' (dio8) and slave 4 'e' (sv33-e): who stands between them does not answer"),
                          Not(HasSubstr("port 1"))));
    }
}

// A coupler has no process data: that it is not exchanged says nothing, and that it is in INIT says that it began anew.
TEST(TwoAtOnce, OfACouplerThatRestartsNobodyElseIsAccused) {
    for (const Duration away : {Duration{1ms}, Duration{300ms}}) {
        Bench bench{"otos", ""};
        static Duration for_so_long{};
        for_so_long = away;
        const auto said = heard_after(bench, [](Bench& b) {
            b.network.set_power(b.there('a'), false);
            b.run_for(for_so_long);
            b.network.set_power(b.there('a'), true);
        });
        for (const auto& one : said) EXPECT_THAT(one.id, ::testing::AnyOf("slave_lost", "frames_lost")) << one.place;
        EXPECT_THAT(place_of(said, "slave_lost"), HasSubstr("slave 0 'a' (junction)"));
    }
}

TEST(TwoAtOnce, WhoLosesItsPowerWhileAnotherComesBackIsLostAndNothingElse) {
    Bench bench{"stttt", ""};
    ASSERT_TRUE(bench.bring_up()) << bench.why();
    bench.run_for(300ms);
    for (int after = 0; after < 40; after += 3) {
        bench.network.set_power(bench.there('c'), false);
        bench.run_for(300ms);
        bench.network.set_power(bench.there('c'), true);
        bench.run_for(Duration{1ms} * after);
        bench.network.set_power(bench.there('e'), false);
        for (const auto& one : bench.what_alarms_say({}))
            EXPECT_THAT(one.id, ::testing::AnyOf("slave_lost", "cable_broken")) << after << " ms: " << one.place;
        bench.network.set_power(bench.there('e'), true);
        bench.run_for(12s);
        ASSERT_THAT(bench.faults(), ::testing::IsEmpty()) << after;
    }
}

}  // namespace
}  // namespace taktwerk::troubles
