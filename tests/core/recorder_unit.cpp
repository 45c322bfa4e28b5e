#include "core/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <thread>
#include <vector>

#include "core/bytes.hpp"
#include "tests/patience.hpp"

namespace taktwerk {
namespace {

struct Record {
    RecordChannel channel;
    std::int64_t time;
    std::vector<std::byte> bytes;
    friend bool operator==(const Record&, const Record&) = default;
};

Record copy_of(const RecordView& view) {
    return {view.channel, view.time.time_since_epoch().count(), {view.bytes.begin(), view.bytes.end()}};
}

template <class Records = std::vector<Record>>
Records all_of(const Recorder& recorder) {
    Records out;
    recorder.for_each([&](const RecordView& view) { out.push_back(copy_of(view)); });
    return out;
}

bool append(Recorder& recorder, const Record& r) { return recorder.append(r.channel, Instant{Duration{r.time}}, r.bytes); }

Record random_record(std::mt19937& random, std::int64_t time, std::size_t longest) {
    Record record{static_cast<RecordChannel>(random() % 5), time, std::vector<std::byte>(random() % (longest + 1))};
    for (auto& b : record.bytes) b = static_cast<std::byte>(random());
    return record;
}

std::size_t room(const Record& r) { return 16 + (r.bytes.size() + 15) / 16 * 16; }

TEST(Recorder, RecordsComeBackInOrderWithChannelTimeAndBytes) {
    Recorder recorder{4096, Recorder::Policy::drop_newest};
    const std::vector<Record> records{{1, 10, {std::byte{1}}}, {0, -5, {}}, {7, 20, std::vector<std::byte>(100, std::byte{9})}};

    for (const auto& r : records) ASSERT_TRUE(append(recorder, r));

    EXPECT_EQ(all_of(recorder), records);
    EXPECT_EQ(recorder.recorded(), 3u);
}

TEST(Recorder, DropNewestKeepsTheOldAndCountsWhatIsLost) {
    Recorder recorder{64, Recorder::Policy::drop_newest};
    const Record r{1, 1, {std::byte{1}}};  // 32 bytes with its frame
    EXPECT_TRUE(append(recorder, r));
    EXPECT_TRUE(append(recorder, r));

    EXPECT_FALSE(append(recorder, {2, 2, {std::byte{2}}}));

    EXPECT_EQ(recorder.dropped(), 1u);
    EXPECT_THAT(all_of(recorder), testing::ElementsAre(r, r));
}

TEST(Recorder, OverwriteOldestAlwaysHoldsTheLastMoments) {
    std::mt19937 random{3};
    Recorder recorder{1024, Recorder::Policy::overwrite_oldest};
    std::deque<Record> written;

    for (std::int64_t i = 0; i < 5000; ++i) {
        written.push_back(random_record(random, i, 100));
        ASSERT_TRUE(append(recorder, written.back()));

        const auto kept = all_of<std::deque<Record>>(recorder);
        ASSERT_EQ(recorder.overwritten(), static_cast<std::uint64_t>(i) + 1 - kept.size());
        while (written.size() > kept.size()) written.pop_front();
        ASSERT_EQ(kept, written);
        std::size_t used = 0;
        for (const auto& r : kept) used += room(r);
        ASSERT_TRUE(i < 50 || used > 1024 - 3 * 128) << "it forgets more than it must";
    }
}

TEST(Recorder, ARecordOfHalfTheCapacityAlwaysFitsAndALongerOneIsDropped) {
    Recorder recorder{256, Recorder::Policy::overwrite_oldest};
    const Record half{0, 0, std::vector<std::byte>(112)};
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(append(recorder, {1, i, {}}));  // shifts the positions
        ASSERT_TRUE(append(recorder, half));
    }
    EXPECT_FALSE(append(recorder, {0, 0, std::vector<std::byte>(113)}));
    EXPECT_EQ(recorder.dropped(), 1u);
}

TEST(Recorder, ClearForgetsRecordsAndCounters) {
    Recorder recorder{64, Recorder::Policy::drop_newest};
    for (int i = 0; i < 5; ++i) append(recorder, {1, i, {}});
    recorder.clear();
    EXPECT_TRUE(all_of(recorder).empty());
    EXPECT_EQ(recorder.dropped(), 0u);
}

TEST(Recorder, OneThreadMayDrainWhileTheCycleAppends) {
    constexpr std::int64_t count = 20'000;
    Recorder recorder{512, Recorder::Policy::drop_newest};
    std::thread cycle{[&] {
        auto patience = Patience::of_threads();
        std::array<std::byte, 40> bytes{};
        for (std::int64_t i = 0; i < count; ++i) {
            const auto length = static_cast<std::size_t>(i % 33) + 8;
            store_le(std::span<std::byte>{bytes}, 0, i);
            while (patience.lasts(!recorder.append(3, Instant{Duration{i}}, std::span{bytes}.first(length)))) std::this_thread::yield();
        }
    }};

    std::int64_t expected = 0, wrong = 0;
    for (auto patience = Patience::of_threads(); patience.lasts(expected < count);) {
        recorder.drain([&](const RecordView& view) {
            const bool right = view.channel == 3 && view.time == Instant{Duration{expected}} &&
                               view.bytes.size() == static_cast<std::size_t>(expected % 33) + 8 &&
                               load_le<std::int64_t>(view.bytes) == expected;
            wrong += !right;
            ++expected;
        });
        std::this_thread::yield();
    }
    cycle.join();

    EXPECT_EQ(wrong, 0);
    EXPECT_TRUE(all_of(recorder).empty());
}

}  // namespace
}  // namespace taktwerk
