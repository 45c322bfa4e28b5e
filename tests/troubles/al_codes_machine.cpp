// Whatever AL status code a slave gives: it is told with the standard's words and with what to do, in the one message that names the slave.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/wire/al_status.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {
namespace {

using ecat::AlStatusInfo;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string with_words(const AlStatusInfo& info) { return fmt::format("{:04X}h {}", info.code, info.text); }

/// `bus why` has one more page for nobody, and nobody else stands in what it says.
void expect_told_of_b(const std::vector<Said>& said, const AlStatusInfo& info) {
    const Trouble row{.name = "code", .staged = "code", .named = "b"};
    ASSERT_THAT(said, SizeIs(1)) << with_words(info);
    EXPECT_THAT(said[0].place, HasSubstr("slave 1 'b'")) << with_words(info);
    EXPECT_LE(said[0].after, 2s) << with_words(info);
    EXPECT_THAT(accused(row, said[0]), IsEmpty()) << said[0].place << " | " << said[0].cause << " | " << said[0].remedy;
}

TEST(AlStatusCodes, OfAStateThatIsRefusedAtTheStartAreToldWithTheirWordsAndARemedy) {
    for (const auto& info : ecat::al_status_codes()) {
        if (info.code == 0) continue;  // no error: nothing is refused with it
        Bench bench{"sst", ""};
        bench.there('b').refuse_state(ecat::sim::EsmState::safeop, info.code);
        const auto said = bench.what_why_says();
        expect_told_of_b(said, info);
        ASSERT_THAT(said, SizeIs(1));
        EXPECT_THAT(said[0].cause, HasSubstr(with_words(info)));
        EXPECT_FALSE(said[0].remedy.empty() || said[0].remedy == "look the code up in the slave's manual") << with_words(info);
        EXPECT_THAT(bench.master->failure().text(), AllOf(HasSubstr(with_words(info)), HasSubstr(said[0].remedy))) << "what `run` says";
    }
}

TEST(AlStatusCodes, OfASlaveThatLeavesOpAreToldWithTheirWordsAndARemedy) {
    for (const auto& info : ecat::al_status_codes()) {
        if (info.code == 0) continue;
        Bench bench{"sst", ""};
        ASSERT_TRUE(bench.bring_up()) << bench.why();
        bench.run_for(300ms);
        bench.there('b').leave_op(info.code, bench.now);
        const auto said = bench.what_alarms_say({});
        expect_told_of_b(said, info);
        EXPECT_EQ(said[0].id, "slave_left_op");
        EXPECT_THAT(said[0].place, AllOf(HasSubstr(with_words(info)), HasSubstr(std::string{info.remedy})));
    }
}

}  // namespace
}  // namespace taktwerk::troubles
