// Whatever the wire does to answers (late by cycles, twice, in another order, another master's among them): inputs are never old
// ones taken for new, and an answer that did not come in time costs its own cycle and no other. Seeds are fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/ecat/test_bus.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

/// Between the master and the in-process cable. Decides about the answers of one cycle when they are first asked for.
class Disturber final : public Transport {
public:
    Disturber(LoopbackTransport& cable, unsigned seed) : cable_(cable), random_(seed) {}

    bool active = false;
    bool held_back = false;  ///< an answer of the last cycle is missing
    std::uint64_t late = 0, twice = 0, strangers = 0;

    bool send(std::span<const std::byte> frame, Instant now) noexcept override { return cable_.send(frame, now); }
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override {
        if (now != asked_) {
            asked_ = now;
            take_over(now);
        }
        for (auto it = waiting_.begin(); it != waiting_.end(); ++it) {
            if (it->at > now) continue;
            const ReceivedFrame received{it->bytes.size(), now};
            std::copy(it->bytes.begin(), it->bytes.end(), buffer.begin());
            waiting_.erase(it);
            return received;
        }
        return std::nullopt;
    }
    [[nodiscard]] MacAddress mac() const noexcept override { return cable_.mac(); }
    [[nodiscard]] bool link_up() const noexcept override { return true; }

private:
    struct Waiting {
        std::vector<std::byte> bytes;
        Instant at{};
    };
    bool one_in(unsigned n) { return random_() % n == 0; }

    void take_over(Instant now) {
        std::array<std::byte, max_frame_size> buffer{};
        std::vector<Waiting> fresh;
        held_back = false;
        while (const auto received = cable_.receive(buffer, now)) {
            Waiting frame{{buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(received->size)}, now};
            if (active && one_in(8)) {
                frame.at = now + static_cast<std::int64_t>(1 + random_() % 5) * 1ms;
                held_back = true;
                ++late;
            }
            if (active && one_in(8)) {
                auto copy = frame;
                copy.at += static_cast<std::int64_t>(random_() % 3) * 1ms;
                fresh.push_back(copy);
                ++twice;
            }
            if (active && one_in(8)) {  // the same datagrams from somebody else's address
                auto copy = frame;
                copy.at = now;
                copy.bytes[11] ^= std::byte{0x55};
                fresh.push_back(copy);
                ++strangers;
            }
            fresh.push_back(std::move(frame));
        }
        if (active) std::shuffle(fresh.begin(), fresh.end(), random_);
        waiting_.insert(waiting_.end(), fresh.begin(), fresh.end());
    }

    LoopbackTransport& cable_;
    std::mt19937 random_;
    std::vector<Waiting> waiting_;
    Instant asked_{};
};

TEST(StaleFrames, CostTheirOwnCycleAndAreNeverTakenForNew) {
    const std::size_t cases = property_cases(4);
    for (unsigned seed = 1; seed <= cases; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        TestBus bus{"tts"};
        for (auto& slave : bus.config.slaves) slave.sm_watchdog = 1s;  // an answer that is late reached the slaves all the same
        Disturber wire{bus.transport, seed};
        bus.master = std::make_unique<Master>(wire, bus.config);
        ASSERT_TRUE(bus.bring_up()) << bus.why();
        const auto output = Signal{bus.master->output(0, 0x7000, 1).value().bit_offset, 8, false};
        const auto input = Signal{bus.master->input(0, 0x6000, 1).value().bit_offset, 8, false};

        std::uint8_t counter = 0;
        const auto lag = [&] {  // of the terminal's inverted echo behind what is sent now
            return static_cast<std::uint8_t>(counter - static_cast<std::uint8_t>(~read_signal(bus.master->inputs(), input)));
        };
        bus.on_cycle = [&] { write_signal(bus.master->outputs(), output, ++counter); };
        bus.run_for(20ms);
        const auto undisturbed = lag();
        const auto lost_before = bus.master->statistics().frames_lost;

        wire.active = true;
        int disturbed = 0;
        for (int i = 0; i < 2000; ++i) {
            bus.cycle_once();
            if (bus.master->health(0).fresh) {
                ASSERT_EQ(lag(), undisturbed) << "cycle " << i << ": old inputs were taken for new";
            } else {
                ++disturbed;
                ASSERT_TRUE(wire.held_back) << "cycle " << i << ": nothing was late, but the inputs are not fresh";
            }
        }
        wire.active = false;
        bus.run_for(20ms);
        const auto& seen = bus.master->statistics();
        EXPECT_GT(disturbed, 100);
        EXPECT_LE(static_cast<std::uint64_t>(disturbed), wire.late);
        EXPECT_EQ(seen.frames_foreign, wire.strangers);
        EXPECT_GE(seen.frames_late, seen.frames_lost - lost_before) << "each comes after it was given up";
        EXPECT_TRUE(bus.master->health(0).fresh);
    }
}

}  // namespace
}  // namespace taktwerk::ecat::test
