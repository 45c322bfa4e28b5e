// The state over LCM is the state over the socket, to the last digit; what does not come whole is counted and never shown.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <nlohmann/json.hpp>

#include "hmi_bridge/lcm/memory_bus.hpp"
#include "hmi_bridge/lcm/publisher.hpp"
#include "hmi_bridge/lcm/whole_message.hpp"
#include "hmi_bridge/lcm/whole_states.hpp"
#include "hmi_bridge/lcm_types/our_types.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "tests/hmi_bridge/rich_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using test::FakeMachine;
using test::name_of_rich_client;
using Bytes = std::vector<std::byte>;

constexpr std::int64_t this_run = 1'800'000'000'000'000;
const std::string channel = "TAKTWERK_DEMO_WHOLE_STATE";

/// A publisher and what it has said on the channel of whole states.
struct Published {
    FakeMachine machine;
    MemoryBus bus;
    Publisher publisher{bus, machine, 50, false, [] { return this_run + 7; }};
    Instant at{1s};

    explicit Published(std::int64_t run = this_run) {
        test::make_rich(machine);
        publisher.publish_whole_states(run, name_of_rich_client);
    }
    /// The message of the next snapshot.
    Bytes next(std::uint64_t seed) {
        test::draw(machine, seed);
        bus.published.clear();
        publisher.step(&machine.snapshot, at += 20ms);
        const auto found = std::find_if(bus.published.begin(), bus.published.end(), [](const auto& one) { return one.channel == channel; });
        return found == bus.published.end() ? Bytes{} : found->bytes;
    }
    [[nodiscard]] std::string socket_state() const { return state_json(machine.snapshot, machine, name_of_rich_client); }
};

TEST(WholeState, LcmBringsTheSocketsStateToTheLastByte) {
    Published published;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const auto message = published.next(seed);
        const auto state = read_whole_state(message);
        ASSERT_TRUE(state) << state.error().text();
        EXPECT_EQ(state_json(*state), published.socket_state()) << "seed " << seed;
        EXPECT_EQ(state->publication, static_cast<std::int64_t>(seed));
        EXPECT_EQ(state->run, this_run);
        EXPECT_EQ(state->utime, this_run + 7);
        ASSERT_FALSE(testing::Test::HasFailure());
    }
}

// A field that nobody writes out would be on the wire and on no page. Names that differ stand here.
TEST(WholeState, EveryFieldStandsInTheState) {
    const std::map<std::string, std::string> otherwise{
        {"cycle_count", "cycle"}, {"cycle_time_ns", "time_ns"}, {"override_velocity", "override"}};
    const std::set<std::string> of_the_message{"utime", "seq", "protocol_version", "run", "publication", "check"};
    const std::set<std::string> by_the_name_of_the_point{"raw", "good"};
    Published published;
    std::string text;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const auto message = published.next(seed);
        text += state_json(*read_whole_state(message));
    }
    int looked_at = 0;
    const auto catalog = our_types();
    for (const auto& [full_name, type] : catalog.types()) {
        if (full_name.find(".whole_") == std::string::npos) continue;
        for (const auto& field : type.fields) {
            if ((type.name.starts_with("whole_state_v") && of_the_message.contains(field.name)) || field.name.ends_with("_count") ||
                field.name.starts_with("has_") || (type.name == "whole_point_v1_t" && by_the_name_of_the_point.contains(field.name)))
                if (!otherwise.contains(field.name)) continue;
            const auto key = otherwise.contains(field.name) ? otherwise.at(field.name) : field.name;
            EXPECT_NE(text.find('"' + key + "\":"), std::string::npos) << full_name << '.' << field.name;
            ++looked_at;
        }
    }
    EXPECT_GT(looked_at, 150) << "the types were there";
}

TEST(WholeState, ATextWithANulCostsThatCharacterOnly) {
    Published published;
    published.machine.its_layout.axes[0].group = std::string("a\0b", 3);
    const auto state = read_whole_state(published.next(1));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->axes[0].group, "a b");
    EXPECT_EQ(state_json(*state), published.socket_state());
}

// docs/motion/tracking.md: with no command left a group stays on its belt, which takes it along. That is what moves it.
TEST(WholeState, AGroupThatOnlyGoesWithABeltSaysSo) {
    Published published;
    auto& group = published.machine.snapshot.groups.at(0);
    const auto command = [&] { return nlohmann::json::parse(published.socket_state())["groups"][0]["command"]; };
    group.active = 0;
    EXPECT_EQ(command(), "");
    group.track.kind = axes::FrameTrack::Kind::belt;
    EXPECT_EQ(command(), "MC_TrackConveyorBelt");
    group.track.kind = axes::FrameTrack::Kind::table;
    EXPECT_EQ(command(), "MC_TrackRotaryTable");
    group.active = 5;
    group.active_kind = axes::GroupCommandKind::linear_absolute;
    EXPECT_EQ(command(), "MC_MoveLinearAbsolute");
}

TEST(WholeState, IsPublishedFiftyTimesASecondAtMostAndOnlyWhenAsked) {
    FakeMachine machine;
    MemoryBus bus;
    Publisher publisher{bus, machine, 1000, false, [] { return this_run; }};
    const auto said = [&] {
        return std::count_if(bus.published.begin(), bus.published.end(), [](const auto& one) { return one.channel == channel; });
    };
    publisher.step(&machine.snapshot, Instant{1s});
    EXPECT_EQ(said(), 0);
    publisher.publish_whole_states(this_run, name_of_rich_client);
    for (int ms = 1; ms <= 1000; ++ms) publisher.step(&machine.snapshot, Instant{1s + ms * 1ms});
    EXPECT_EQ(said(), 50);
}

TEST(WholeStates, AGapIsCountedAndTheNewestIsTaken) {
    Published published;
    WholeStates states{this_run};
    EXPECT_FALSE(states.take());
    EXPECT_EQ(states.came(), Instant{});
    states.receive(published.next(1), Instant{1s});
    static_cast<void>(published.next(2));
    static_cast<void>(published.next(3));
    states.receive(published.next(4), Instant{2s});

    const auto state = states.take();

    ASSERT_TRUE(state);
    EXPECT_EQ(state_json(*state), published.socket_state());
    EXPECT_EQ(states.lost(), 2u);
    EXPECT_EQ(states.came(), Instant{2s});
    EXPECT_FALSE(states.take()) << "once";
}

// The machine was started again: its socket says another run, and what the old one has left on the way is of nobody.
TEST(WholeStates, AnotherRunIsNotMixedIn) {
    Published old, anew{this_run + 5};
    for (std::uint64_t seed = 1; seed < 9; ++seed) static_cast<void>(old.next(seed));
    const auto late = old.next(9);
    WholeStates states{this_run + 5};
    states.receive(anew.next(1), Instant{1s});
    const auto shown = anew.socket_state();
    states.receive(late, Instant{1s});
    EXPECT_EQ(states.foreign(), 1u);
    EXPECT_EQ(state_json(*states.take()), shown) << "from its first publication on";
    EXPECT_EQ(states.lost(), 0u);
}

TEST(WholeStates, WhatWasMissedWhileNobodyListenedIsNotLost) {
    Published published;
    WholeStates states{this_run};
    states.receive(published.next(1), Instant{1s});
    states.look_away();
    for (std::uint64_t seed = 2; seed <= 5000; ++seed) static_cast<void>(published.next(seed));
    states.receive(published.next(5001), Instant{101s});
    EXPECT_EQ(states.lost(), 0u);
    EXPECT_EQ(states.refused(), 0u);
    EXPECT_EQ(states.take()->publication, 5001);
}

TEST(WholeStates, APublicationFarAheadBlocksNothing) {
    Published published;
    WholeStates states{this_run};
    states.receive(published.next(1), Instant{1s});
    auto lie = *read_whole_state(published.next(2));
    lie.publication = std::numeric_limits<std::int64_t>::max();
    Bytes buffer;
    const auto written = write_whole_state(lie, buffer);
    ASSERT_FALSE(written.empty());
    states.receive(written, Instant{1s});
    EXPECT_EQ(states.refused(), 1u);
    states.receive(published.next(3), Instant{2s});
    EXPECT_EQ(states.take()->publication, 3);
}

// Whatever a network does to datagrams: what is shown was published so, whole, and each later than the one before.
TEST(WholeStates, ShowOnlyWhatWasPublishedWhole) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 random{seed};
        Published published;
        WholeStates states{this_run};
        std::set<std::string> said;
        std::vector<Bytes> on_the_way;
        std::int64_t shown = 0;
        int times_shown = 0, damaged = 0;
        const auto look = [&] {
            const auto state = states.take();
            if (!state) return;
            ++times_shown;
            EXPECT_TRUE(said.contains(state_json(*state))) << "seed " << seed << ": nobody has published that";
            EXPECT_GT(state->publication, shown) << "seed " << seed;
            shown = state->publication;
        };
        for (int publication = 0; publication < 60; ++publication) {
            auto message = published.next(random());
            said.insert(published.socket_state());
            if (random() % 4 == 0) continue;  // lost
            on_the_way.push_back(message);
            if (random() % 4 == 0) on_the_way.push_back(message);  // doubled
            if (random() % 2 == 0) {                               // garbled: a bit, a tail, two in one, more behind
                ++damaged;
                auto bad = message;
                switch (random() % 4) {
                    case 0: bad[random() % bad.size()] ^= static_cast<std::byte>(1u << random() % 8); break;
                    case 1: bad.resize(random() % bad.size()); break;
                    case 2: {
                        const auto& other = on_the_way.front();
                        const auto at = std::min(bad.size(), other.size()) / 2;
                        std::copy_n(other.begin(), at, bad.begin());
                        if (bad == message || bad == other) --damaged;
                        break;
                    }
                    default: bad.insert(bad.end(), message.begin(), message.end());
                }
                on_the_way.push_back(std::move(bad));
            }
            if (on_the_way.size() > 4 || random() % 2 == 0) {
                std::shuffle(on_the_way.begin(), on_the_way.end(), random);
                for (const auto& one : on_the_way) {
                    states.receive(one, published.at);
                    if (random() % 3 == 0) look();
                }
                on_the_way.clear();
            }
        }
        look();
        EXPECT_GT(times_shown, 5) << "seed " << seed;
        EXPECT_GT(states.lost(), 0u);
        EXPECT_GT(states.refused(), 0u);
        EXPECT_LE(states.refused(), static_cast<std::uint64_t>(damaged));
        ASSERT_FALSE(testing::Test::HasFailure());
    }
}

}  // namespace
}  // namespace taktwerk::hmi
