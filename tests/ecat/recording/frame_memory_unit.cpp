// The last moments of a bus, looked at while it goes on.

#include "ecat/recording/frame_memory.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <vector>

#include "core/bytes.hpp"
#include "tests/patience.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr std::size_t frame_size = 100;

/// Frame `number`, at so many milliseconds; odd ones come in.
void pass(FrameMemory& memory, std::uint32_t number) {
    std::vector<std::byte> frame(frame_size, static_cast<std::byte>(number));
    store_le(std::span{frame}, 0, number);
    FrameMemory::tap(&memory, frame, Instant{} + number * 1ms, number % 2 == 0);
}

std::vector<std::uint32_t> numbers(const Recorder& moments) {
    std::vector<std::uint32_t> all;
    moments.for_each([&](const RecordView& record) {
        const auto number = load_le<std::uint32_t>(record.bytes, 0);
        all.push_back(number);
        EXPECT_EQ(record.bytes.size(), frame_size);
        EXPECT_EQ(record.bytes.back(), static_cast<std::byte>(number));
        EXPECT_EQ(record.time, Instant{} + number * 1ms);
        EXPECT_EQ(record.channel, number % 2 == 0 ? sent_frames : received_frames);
    });
    return all;
}

TEST(FrameMemory, GivesTheNewestInTheirOrderAndGoesOn) {
    FrameMemory memory{512};  // four frames of 100 and 28 bytes
    for (std::uint32_t i = 0; i < 10; ++i) pass(memory, i);
    EXPECT_EQ(memory.asked(), nullptr) << "nobody has";

    memory.ask();
    EXPECT_EQ(memory.asked(), nullptr) << "the cycle may still be in there";
    pass(memory, 10);
    ASSERT_NE(memory.asked(), nullptr);
    pass(memory, 11);
    EXPECT_THAT(numbers(*memory.asked()), ElementsAre(6, 7, 8, 9));
    EXPECT_THAT(numbers(memory.at_end()), ElementsAre(10, 11));

    memory.ask();
    pass(memory, 12);
    EXPECT_THAT(numbers(*memory.asked()), ElementsAre(6, 7, 8, 9)) << "one at a time";
    memory.give_back();
    EXPECT_EQ(memory.asked(), nullptr);

    memory.ask();
    pass(memory, 13);
    ASSERT_NE(memory.asked(), nullptr);
    EXPECT_THAT(numbers(*memory.asked()), ElementsAre(10, 11, 12));
    EXPECT_THAT(numbers(memory.at_end()), ElementsAre(13)) << "what was given back was empty";
}

// With a thread for each side: no frame that is looked at is ever half of another one. (tsan sees the rest.)
TEST(FrameMemory, AReaderSeesWholeFramesWhileTheCycleGoesOn) {
    FrameMemory memory{std::size_t{1} << 14};
    std::atomic<bool> ended{false};
    std::thread cycle{[&] {
        for (std::uint32_t i = 0; !ended.load(); ++i) pass(memory, i);
    }};
    std::uint32_t newest = 0;
    Patience patience = Patience::of_threads();
    for (int looked = 0; patience.lasts(looked < 200);) {
        memory.ask();
        const auto* moments = memory.asked();
        if (moments == nullptr) {
            std::this_thread::yield();
            continue;
        }
        const auto all = numbers(*moments);
        for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i], all[i - 1] + 1) << "none is missing between two";
        if (!all.empty()) {
            EXPECT_GE(all.front(), newest);
            newest = all.back();
        }
        memory.give_back();
        ++looked;
    }
    ended.store(true);
    cycle.join();
}

}  // namespace
}  // namespace taktwerk::ecat
