// How much memory the scope may take, and what is said about it.
#include "runtime/check/recording_memory.hpp"

#include <gmock/gmock.h>

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr std::size_t gigabyte = 1'000'000'000;

// 64 axes at 1 ms: 772 words. Nobody has to hear of 124 MB.
TEST(RecordingMemory, AUsualMachineIsNoRemark) {
    constexpr std::size_t bytes = std::size_t{772} * 8 * 20'001;
    EXPECT_FALSE(recording_remark(20s, bytes, 8 * gigabyte));
    EXPECT_TRUE(recording_fits(20s, bytes, 8 * gigabyte).ok());
}

TEST(RecordingMemory, MuchIsARemarkWithADepthThatTakesLess) {
    const auto remark = recording_remark(20s, 1'235'200'000, 24 * gigabyte);  // the same at 100 us
    ASSERT_TRUE(remark);
    EXPECT_EQ(remark->code, "remark.recording_memory");
    EXPECT_EQ(remark->subject, "recording.depth");
    EXPECT_THAT(remark->what, HasSubstr("20 s of every signal of every cycle take 1235 MB"));
    EXPECT_THAT(remark->what, HasSubstr("(this computer has 24000 MB)"));
    EXPECT_THAT(remark->remedy, HasSubstr("{depth: 4 s}")) << "256 MB";
}

TEST(RecordingMemory, MoreThanHalfOfTheComputerIsRefused) {
    EXPECT_TRUE(recording_fits(20s, gigabyte, 2 * gigabyte).ok());
    const auto refused = recording_fits(20s, gigabyte + 1, 2 * gigabyte);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "recording.memory");
    EXPECT_THAT(refused.error().what, HasSubstr("this computer has 2000 MB"));
    EXPECT_THAT(refused.error().remedy, HasSubstr("{depth: 19 s}"));
    EXPECT_THAT(recording_remark(20s, gigabyte + 1, 2 * gigabyte)->what, HasSubstr("would refuse"));
    EXPECT_TRUE(recording_fits(20s, gigabyte, 0).ok()) << "not known";
    EXPECT_THAT(recording_fits(400ms, 4 * gigabyte, gigabyte).error().remedy, HasSubstr("{depth: 0.1 s}"));
}

}  // namespace
}  // namespace taktwerk::runtime
