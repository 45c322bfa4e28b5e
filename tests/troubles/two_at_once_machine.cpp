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

}  // namespace
}  // namespace taktwerk::troubles
