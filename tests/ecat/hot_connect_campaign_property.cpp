// The hot-connect campaign: a tool of two slaves is plugged in, pulled, pulled while it joins, and plugged in again, in every socket and in every
// phase of the bus. TAKTWERK_REGENERATE=1 writes docs/hot-connect-campaign.md; TAKTWERK_SOAK_FACTOR draws more seeds.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "core/process_image.hpp"
#include "ecat/alarms.hpp"
#include "tests/ecat/hot_connect_bus.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

const std::string page = std::string{TAKTWERK_SOURCE_DIR} + "/docs/hot-connect-campaign.md";
constexpr std::size_t usual_seeds = 6;
constexpr std::size_t residents = 3, tool_servo = 4;

struct When {
    const char* text;
    BusPhase phase;
    bool recovery;  ///< while a slave that is always there is on its way back to OP
};
constexpr std::array moments{
    When{"the slaves are found", BusPhase::scanning, false},
    When{"they are taken to PREOP", BusPhase::preop, false},
    When{"their process data is laid out", BusPhase::configuring, false},
    When{"they are taken to SAFEOP and OP", BusPhase::safeop, false},
    When{"the bus is in operation", BusPhase::operational, false},
    When{"another slave is on its way back to OP", BusPhase::operational, true},
};
struct Where {
    const char* text;
    Socket socket;
};
constexpr std::array sockets{
    Where{"side of the first slave", Socket::side_of_first},
    Where{"side of the last slave", Socket::side_of_last},
    Where{"end of the line", Socket::end},
};

struct Tally {
    std::size_t runs = 0, changes = 0, lost_a_cycle = 0, most_lost = 0;
    Duration longest_join{};
    int restarts = 0;
};

/// One run; the same seed gives the same one.
class HotRun {
public:
    HotRun(const Where& where, const When& when, std::uint32_t seed)
        : what_(fmt::format("{}, while {}, seed {}", where.text, when.text, seed)), when_(when), random_(seed), bus_(where.socket) {
        for (std::size_t i = 0; i < bus_.network.size(); ++i) bus_.network.slave(i).controller().set_clock_drift(draw_ppm(), Instant{});
        bus_.on_cycle = [this] { look(); };
    }

    void go(Tally& tally) {
        SCOPED_TRACE(what_);
        ++tally.runs;
        bus_.plug(false);
        ASSERT_TRUE(reach_phase()) << bus_.why();
        change(true, tally);
        ASSERT_TRUE(comes_up(tally)) << bus_.why() << ::testing::PrintToString(notes());
        joins(tally);
        change(false, tally);
        bus_.run_for(5ms);
        EXPECT_EQ(bus_.presence(), GroupPresence::absent);
        bus_.run_for(draw(10ms, 300ms));
        change(true, tally);
        bus_.run_for(draw(0ms, 120ms));  // somewhere on its way
        change(false, tally);
        bus_.run_for(draw(0ms, 300ms));
        change(true, tally);
        joins(tally);
        bus_.run_for(300ms);
        EXPECT_TRUE(bus_.faults().empty()) << ::testing::PrintToString(bus_.faults());
        EXPECT_TRUE(said_.empty()) << ::testing::PrintToString(said_) << ::testing::PrintToString(notes());
        EXPECT_EQ(missed_, 0) << ::testing::PrintToString(notes());
        EXPECT_LT(bus_.master->statistics().dc_difference_ns, 3000);
    }

private:
    Duration draw(Duration least, Duration most) {
        return Duration{std::uniform_int_distribution<std::int64_t>{least.count(), most.count()}(random_)};
    }
    double draw_ppm() { return std::uniform_real_distribution{-60.0, 60.0}(random_); }
    [[nodiscard]] std::vector<std::string> notes() const { return {bus_.master->notes().begin(), bus_.master->notes().end()}; }

    bool reach_phase() {
        bus_.start();
        const auto ended = [&] {
            const auto phase = bus_.master->phase();
            return phase == when_.phase || phase == BusPhase::operational || phase == BusPhase::failed;
        };
        if (!bus_.run_until(ended, 20s) || bus_.master->phase() == BusPhase::failed) return false;
        bus_.run_for(draw(0ms, when_.phase == BusPhase::operational ? 500ms : 15ms));
        if (!when_.recovery) return true;
        recovering_ = 1;
        bus_.network.slave(recovering_).leave_op(0x001B, bus_.now);
        bus_.run_for(draw(0ms, 40ms));
        return true;
    }
    bool comes_up(Tally& tally) {
        for (int attempt = 0; attempt < 3; ++attempt) {
            bus_.run_until([&] { return bus_.master->phase() == BusPhase::operational || bus_.master->phase() == BusPhase::failed; }, 20s);
            if (bus_.master->phase() == BusPhase::operational) return true;
            ++tally.restarts;
            bus_.master->start();
        }
        return false;
    }
    /// At any moment between two frames.
    void change(bool plugged, Tally& tally) {
        bus_.network.advance(bus_.now + draw(0us, 990us));
        bus_.plug(plugged);
        ++tally.changes;
        lost_ = 0;
        bus_.run_for(3ms);
        tally.lost_a_cycle += lost_ > 0 ? 1 : 0;
        tally.most_lost = std::max(tally.most_lost, lost_);
    }
    void joins(Tally& tally) {
        const Instant began = bus_.now;
        ASSERT_TRUE(bus_.joins(5s)) << ::testing::PrintToString(notes());
        tally.longest_join = std::max(tally.longest_join, bus_.now - began);
        recovering_ = residents;
        write_signal(bus_.master->outputs(), bus_.master->output(tool_servo, 0x607A, 0).value(), ++target_);
        bus_.run_for(5ms);
        EXPECT_TRUE(bus_.master->health(tool_servo).fresh);
        EXPECT_EQ(read_signal(bus_.master->inputs(), bus_.master->input(tool_servo, 0x6064, 0).value()), target_);
    }
    /// In each cycle: told is what is exchanged, and whoever is always there is exchanged and not accused.
    void look() {
        if (bus_.master->phase() != BusPhase::operational) return;
        const bool answered = bus_.master->statistics().lost_in_a_row == 0;
        lost_ += answered ? 0 : 1;
        for (std::size_t slave = 0; slave < residents; ++slave)
            if (answered && slave != recovering_ && !bus_.master->health(slave).fresh) ++missed_;
        for (const auto& fact : bus_.facts())
            if (!(fact.source == AlarmSource::slave && fact.index == recovering_)) said_.insert(fact.id);
        const bool fresh = bus_.master->health(tool_servo).fresh;
        if (fresh && bus_.presence() != GroupPresence::present) said_.insert(0);
    }

    std::string what_;
    When when_;
    std::mt19937 random_;
    HotConnectBus bus_;
    std::set<AlarmId> said_;
    std::size_t recovering_ = residents;
    std::size_t lost_ = 0;
    int missed_ = 0;
    std::int64_t target_ = 1000;
};

std::string page_of(const std::vector<std::pair<std::string, Tally>>& rows, std::size_t seeds) {
    std::string out = fmt::format(R"(# The hot-connect campaign

Generated by `ecat_property`; do not edit. A servo with SYNC0 and two terminals are always there; a tool of a terminal and a servo with SYNC0 is plugged into one of three sockets
while something else is going on, pulled, plugged in, pulled on its way to OP, and plugged in again: each at any moment of the cycle; quartzes are up to 60 ppm off; {} seeds a row.
How groups work: [hot-connect.md](hot-connect.md).

In every run: whoever is always there is exchanged in each cycle whose frame comes back; no alarm; the group is told present only while it is exchanged, and absent five cycles after
it was pulled; in the end it is in OP, takes its set-points and agrees with the reference clock. The frames that are under way when a plug is put in or pulled count as lost.

| socket | plugged in while | runs | plugs put in or pulled | of them lost a cycle | most cycles lost by one | longest way to OP |
|---|---|---|---|---|---|---|
)",
                                  seeds);
    for (const auto& [name, tally] : rows)
        out += fmt::format("| {} | {} | {} | {} | {} | {} ms |\n", name, tally.runs, tally.changes, tally.lost_a_cycle, tally.most_lost,
                           tally.longest_join / 1ms);
    return out;
}

TEST(HotConnectCampaign, EverySocketInEveryPhase) {
    std::vector<std::pair<std::string, Tally>> rows;
    const std::size_t seeds = property_cases(usual_seeds);
    int restarts = 0;
    for (const auto& where : sockets)
        for (const auto& when : moments) {
            auto& [name, tally] = rows.emplace_back(fmt::format("{} | {}", where.text, when.text), Tally{});
            for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
                HotRun run{where, when, seed};
                run.go(tally);
            }
            restarts += tally.restarts;
        }
    EXPECT_EQ(restarts, 0) << "bring-ups that failed because a tool was plugged in meanwhile";
    const std::string text = page_of(rows, seeds);
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream{page} << text;
    if (seeds != usual_seeds) return;
    std::ifstream file{page};
    std::stringstream shown;
    shown << file.rdbuf();
    EXPECT_EQ(shown.str(), text) << "TAKTWERK_REGENERATE=1 build/dev/ecat/ecat_property --gtest_filter='HotConnectCampaign*'";
}

}  // namespace
}  // namespace taktwerk::ecat::test
