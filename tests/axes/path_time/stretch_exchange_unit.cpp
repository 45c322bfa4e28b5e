// From the planner to the cycle, and back again where the cycle has not come to it: each stretch is taken once, whole, or not at all.

#include "axes/path_time/stretch_exchange.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

void offer(StretchExchange& exchange, std::uint32_t id) {
    TimeStretch* stretch = exchange.free_stretch();
    ASSERT_NE(stretch, nullptr);
    stretch->id = id;
    exchange.offer();
}

TEST(StretchExchange, AnOfferIsTakenBackUntilTheCycleLooksAtIt) {
    const auto exchange = std::make_unique<StretchExchange>();
    EXPECT_FALSE(exchange->take_back());
    offer(*exchange, 1);
    EXPECT_EQ(exchange->free_stretch(), nullptr);
    EXPECT_TRUE(exchange->take_back());
    EXPECT_FALSE(exchange->take_back());
    EXPECT_EQ(exchange->look(), nullptr);

    offer(*exchange, 2);
    const TimeStretch* seen = exchange->look();
    ASSERT_NE(seen, nullptr);
    EXPECT_EQ(seen->id, 2u);
    EXPECT_FALSE(exchange->take_back());
    EXPECT_TRUE(exchange->offering());
    exchange->leave();
    EXPECT_TRUE(exchange->take_back());

    offer(*exchange, 3);
    seen = exchange->look();
    ASSERT_NE(seen, nullptr);
    EXPECT_EQ(seen->id, 3u);
    exchange->tell({3, 0});
    exchange->answer();
    EXPECT_FALSE(exchange->take_back());
    EXPECT_FALSE(exchange->offering());
    EXPECT_EQ(exchange->progress().stretch, 3u);
    exchange->was_taken();
    offer(*exchange, 4);
    const TimeStretch* next = exchange->look();
    ASSERT_NE(next, nullptr);
    EXPECT_NE(next, seen);
}

// A planner that changes its mind all the time beside a cycle that looks all the time.
TEST(StretchExchange, TwoThreadsAgreeOnWhatWasTaken) {
    constexpr std::uint32_t offers = 5000;
    const auto exchange = std::make_unique<StretchExchange>();
    std::atomic<bool> over{false};
    std::uint64_t taken_by_cycle = 0, torn = 0;
    std::thread cycle([&] {
        for (std::uint64_t turn = 0; !over.load(std::memory_order_acquire); ++turn) {
            const TimeStretch* next = exchange->look();
            if (next == nullptr) {
                std::this_thread::yield();
                continue;
            }
            torn += next->at_piece == static_cast<int>(next->id % 1000) && next->count == next->at_piece + 1 ? 0 : 1;
            if (turn % 3 == 0) {
                exchange->leave();
                continue;
            }
            ++taken_by_cycle;
            exchange->tell({next->id, 0});
            exchange->answer();
        }
    });
    std::uint64_t taken = 0, back = 0, lost = 0;
    for (std::uint32_t id = 1; id <= offers; ++id) {
        TimeStretch* stretch = exchange->free_stretch();
        stretch->id = id;
        stretch->at_piece = static_cast<int>(id % 1000);
        stretch->count = stretch->at_piece + 1;
        exchange->offer();
        bool mine = false;
        for (std::uint32_t i = 0; exchange->offering() && !mine; ++i) {
            if (id % 5 == 0) std::this_thread::yield();
            else if (i >= id % 5) mine = exchange->take_back();
        }
        if (mine) {
            ++back;
            continue;
        }
        lost += exchange->progress().stretch == id ? 0 : 1;
        ++taken;
        exchange->was_taken();
    }
    over.store(true, std::memory_order_release);
    cycle.join();
    EXPECT_EQ(taken, taken_by_cycle);
    EXPECT_GE(taken, offers / 5);
    EXPECT_GT(back, 0u);
    EXPECT_EQ(taken + back, offers);
    EXPECT_EQ(lost, 0u);
    EXPECT_EQ(torn, 0u);
}

}  // namespace
}  // namespace taktwerk::axes
