// Files over a cable that loses, repeats and delays frames, to a slave that is busy when it likes: at each packet something may happen. Each
// message reaches the slave once, so the file arrives as it is, or an error says that it did not, and then the slave holds what it held.
#include <gtest/gtest.h>

#include <random>

#include "tests/ecat/foe/foe_bench.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

struct Weather {
    std::uint32_t lost = 0, unanswered = 0, twice = 0, late = 0, busy = 0;
};

class FilesInBadWeather : public ::testing::Test {
protected:
    static void TearDownTestSuite() {
        // What was drawn did happen.
        EXPECT_GT(seen.lost, 50u);
        EXPECT_GT(seen.unanswered, 50u);
        EXPECT_GT(seen.twice, 50u);
        EXPECT_GT(seen.late, 50u);
        EXPECT_GT(seen.busy, 50u);
        EXPECT_GT(arrived, 20u);
    }
    /// Runs a script while something happens to one frame of `rarity`.
    template <class T>
    static Result<T> run_in(FoeBench& bench, std::mt19937& random, unsigned rarity, Script<Result<T>> script) {
        std::optional<Result<T>> result;
        Runner runner{keep(std::move(script), result)};
        for (int i = 0; i < 2'000'000 && !runner.done(); ++i) {
            bench.step();
            runner.step(bench.now);
            if (random() % rarity == 0) strike(bench, random);
            bench.pack();
        }
        return result ? std::move(*result) : Result<T>{Error{"test.hangs", "", "the script does not end", ""}};
    }
    static void strike(FoeBench& bench, std::mt19937& random) {
        auto& faults = bench.transport->faults;
        switch (random() % 5) {
            case 0: faults.drop_requests = 1, ++seen.lost; break;
            case 1: faults.drop_answers = 1, ++seen.unanswered; break;
            case 2: faults.duplicate_answers = 1, ++seen.twice; break;
            case 3: faults.delay_answers = 1, faults.delay = Duration{static_cast<std::int64_t>(random() % 4'000'000)}, ++seen.late; break;
            default: bench.slave->foe()->faults().busy = static_cast<std::uint32_t>(1 + random() % 3), ++seen.busy;
        }
    }
    static inline Weather seen;
    static inline std::size_t arrived = 0;
};

TEST_F(FilesInBadWeather, ArriveAsTheyAreOrNotAtAll) {
    for (std::size_t n = 0; n < property_cases(80); ++n) {
        std::mt19937 random{static_cast<std::mt19937::result_type>(n + 1)};
        SCOPED_TRACE("seed " + std::to_string(n + 1));
        FoeBench bench;
        // One draw a statement: arguments are evaluated in an order of the compiler's own.
        const std::size_t old_size = 1 + random() % 300;
        const std::size_t size = random() % 1500;
        const Bytes old = pattern(old_size, 3), fresh = pattern(size, static_cast<unsigned>(random()));
        bench.slave->files()->plain() = {{"file", old, 0, false}};
        const auto rarity = static_cast<unsigned>(3 + random() % 30);

        const auto written = run_in(bench, random, rarity, write_file(*bench.port, bench.mailbox, {"file", 0}, fresh, {}));
        ASSERT_TRUE(written) << written.error().text();
        if (written->failure) {
            EXPECT_NE(written->failure->code, "foe.protocol") << written->failure->text();
            EXPECT_TRUE(*bench.stored("file") == old || *bench.stored("file") == fresh) << "never a mixture";
            continue;
        }
        EXPECT_EQ(*bench.stored("file"), fresh);
        const auto read = run_in(bench, random, rarity, read_file(*bench.port, bench.mailbox, {"file", 0}, {}));
        if (!read) {
            EXPECT_NE(read.error().code, "foe.protocol") << read.error().text();
            continue;
        }
        EXPECT_EQ(*read, fresh);
        ++arrived;
    }
}

// One loss at each frame of a transfer in turn, in both directions: it always arrives.
TEST_F(FilesInBadWeather, OneLossAnywhereCostsNothingButTime) {
    const Bytes file = pattern(400);
    for (const bool answer : {false, true}) {
        std::size_t frames = 0;
        {
            FoeBench bench;
            ASSERT_FALSE(bench.write("file", file)->failure);
            frames = bench.frames;
        }
        ASSERT_GE(frames, 10u);
        for (std::size_t n = 1; n <= frames; ++n) {
            SCOPED_TRACE(n);
            FoeBench bench;
            (answer ? bench.lose_answer : bench.lose_request) = n;
            const auto written = bench.write("file", file);
            ASSERT_TRUE(written && !written->failure) << written->failure->text();
            EXPECT_EQ(*bench.stored("file"), file);
        }
    }
}

}  // namespace
}  // namespace taktwerk::ecat::test
