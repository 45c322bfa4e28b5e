// Cables of a ring break and heal, slaves lose power and get it back, in any order and at any moment, also several at once. From outside is
// counted what it costs, told who is reached at all, and compared what slaves were told with what they have: whoever is reached is
// exchanged, whoever was never away is accused of nothing, and at the end all come back.
//
// A failure names its seed; TAKTWERK_WALK_SEED=<seed> runs that walk alone and tells what happened in it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "core/bytes.hpp"
#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "ecat/bringup/scan.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/walk_seeds.hpp"

namespace taktwerk::ecat::test {
namespace {

using RingWalkCounts = std::map<std::string, long, std::less<>>;

/// The cables and supplies of a ring, as whoever pulls them knows them.
struct RingWorld {
    std::vector<bool> cable, power;  // cable n leads to slave n; the last one to the second interface
    explicit RingWorld(std::size_t slaves) : cable(slaves + 1, true), power(slaves, true) {}
    [[nodiscard]] bool from_first(std::size_t slave) const {
        for (std::size_t i = 0; i <= slave; ++i)
            if (!cable[i] || !power[i]) return false;
        return true;
    }
    [[nodiscard]] bool from_second(std::size_t slave) const {
        if (!cable.back()) return false;
        for (std::size_t i = power.size(); i-- > slave;)
            if (!power[i] || (i > slave && !cable[i])) return false;
        return true;
    }
    [[nodiscard]] bool reached(std::size_t slave) const { return from_first(slave) || from_second(slave); }
    [[nodiscard]] bool closed() const {
        return std::find(cable.begin(), cable.end(), false) == cable.end() && std::find(power.begin(), power.end(), false) == power.end();
    }
    [[nodiscard]] std::size_t broken_cables() const { return static_cast<std::size_t>(std::count(cable.begin(), cable.end(), false)); }
    [[nodiscard]] bool all_powered() const { return std::find(power.begin(), power.end(), false) == power.end(); }
    /// Two slaves that the same interface reaches.
    [[nodiscard]] bool together(std::size_t a, std::size_t b) const {
        return (from_first(a) && from_first(b)) || (from_second(a) && from_second(b));
    }
};

class RingWalk {
public:
    RingWalk(unsigned seed, RingWalkCounts& counts)
        : random_(seed), counts_(counts), devices_(draw_devices()), bus_(devices_), world_(devices_.size()) {
        ramp_down_ = once_in(3);
        bus_.make_ring(ramp_down_ ? BehindBreak::ramp_down : BehindBreak::hand_time_on);
        noisy_ = once_in(4);
        for (std::size_t s = 0; s < devices_.size(); ++s)
            bus_.network.slave(s).controller().set_clock_drift(std::uniform_real_distribution{-60.0, 60.0}(random_), bus_.now);
        slaves_.resize(devices_.size());
        broken_in_.resize(world_.cable.size(), -1);
        blinked_.resize(world_.cable.size());
    }

    std::string run(int cycles) {
        if (!bus_.bring_up()) return "the bus does not come up: " + bus_.why();
        for (std::size_t s = 0; s < devices_.size(); ++s) {
            if (devices_[s] != 's') continue;
            slaves_[s].output = bus_.master->output(s, 0x607A, 0)->bit_offset / 8;
            slaves_[s].input = bus_.master->input(s, 0x6064, 0)->bit_offset / 8;
        }
        bus_.on_cycle = [this] { look(); };
        settle(3000);
        for (auto& slave : slaves_) slave.excused = false;
        watching_ = true;
        for (int i = 0; i < cycles && wrong_.empty(); ++i) {
            if (once_in(quiet_ > 0 ? 400 : 30)) happen();
            if (quiet_ > 0) --quiet_;
            else if (once_in(60)) quiet_ = 50 + static_cast<int>(random_() % 1500);
            bus_.cycle_once();
        }
        if (wrong_.empty()) come_back();
        bus_.on_cycle = {};
        return wrong_;
    }
    [[nodiscard]] const std::string& log() const { return log_; }
    bool logs = false;

private:
    struct Watched {
        std::uint32_t output = 0, input = 0;
        bool excused = true;       ///< it was away, and has not been well since
        int well_for = 0;          ///< cycles
        std::uint32_t missed = 0;  ///< SYNC0 without new outputs, as the slave counts them
        std::int32_t seen = -1;
        int stale_for = 0;
    };

    bool once_in(unsigned n) { return random_() % n == 0; }
    std::string draw_devices() {
        std::string out = once_in(3) ? "t" : "s";
        const std::size_t count = 1 + random_() % 6;
        while (out.size() < count) out += once_in(3) ? 't' : 's';
        if (out.find('s') == std::string::npos) out.back() = 's';
        return out;
    }
    void tell(const std::string& text) {
        if (logs) log_ += fmt::format("{}: {}\n", cycle_, text);
    }
    void complain(const std::string& text) {
        if (!wrong_.empty()) return;
        wrong_ = fmt::format("{}{} in cycle {}: {}\n  cables {} power {}; faults: {}\n", devices_, ramp_down_ ? " ramp_down" : "", cycle_,
                             text, bits(world_.cable), bits(world_.power), faults());
        for (std::size_t s = 0; s < slaves_.size(); ++s)
            wrong_ += fmt::format(
                "  slave {}: address {:x}, heard {}, age {}, for {} cycles well\n", s, bus_.network.slave(s).controller().station_address(),
                static_cast<int>(bus_.master->bus().slaves[s]->link.presence.load()), bus_.master->health(s).age, slaves_[s].well_for);
    }
    static std::string bits(const std::vector<bool>& of) {
        std::string out;
        for (const bool b : of) out += b ? '1' : '0';
        return out;
    }
    [[nodiscard]] std::string faults() const {
        std::string out;
        for (const auto& fact : bus_.facts())
            out += fmt::format("{:x}@{}({} {}) ", fact.id, fact.index, fact.a, fact.b) + bus_.master->detail(fact) + "; ";
        return out;
    }

    // --- what happens ---------------------------------------------------------------------------------------------------------------

    void happen() {
        const std::size_t n = 1 + (once_in(4) ? random_() % 2 : 0);
        const Instant at = bus_.now + std::chrono::microseconds{random_() % 3 == 0 ? random_() % 12 : random_() % 900};
        bus_.network.advance(at);
        for (std::size_t i = 0; i < n; ++i) {
            if (noisy_ && once_in(2)) disturb();
            else if (once_in(5)) supply();
            else pull();
        }
        since_event_ = 0;
        // A break that moves within one frame: positions in it are meant for the one before (docs/ring.md).
        if (n > 1) noise_left_ = std::max(noise_left_, 400);
        if (lost_) {
            bus_.transport.lose_under_way(at);
            bus_.second->lose_under_way(at);
        }
        lost_ = false;
    }
    void pull() {
        const bool heal = world_.broken_cables() > 0 && !once_in(3);
        std::size_t c = random_() % world_.cable.size();
        if (heal)
            while (world_.cable[c]) c = (c + 1) % world_.cable.size();
        if (world_.cable[c] && world_.broken_cables() > 1) return;
        world_.cable[c] = !world_.cable[c];
        if (!world_.cable[c]) broken_in_[c] = cycle_;
        else if (broken_in_[c] == cycle_) blinked_[c] = true;
        tell(fmt::format("cable {} {}", c, world_.cable[c] ? "healed" : "broken"));
        ++counts_[world_.cable[c] ? "healed" : world_.broken_cables() > 1 ? "two breaks" : "broken"];
        if (c < devices_.size()) bus_.network.set_cable(c, world_.cable[c]);
        else bus_.network.set_ring_cable(world_.cable[c]);
        lost_ = lost_ || !world_.cable[c];
    }
    void supply() {
        std::size_t s = random_() % world_.power.size();
        if (!world_.all_powered() && !once_in(4))
            while (world_.power[s]) s = (s + 1) % world_.power.size();
        world_.power[s] = !world_.power[s];
        tell(fmt::format("slave {} {}", s, world_.power[s] ? "on" : "off"));
        ++counts_[world_.power[s] ? "on" : "off"];
        bus_.network.set_power(s, world_.power[s]);
        slaves_[s].excused = true;  // also when it is back in the same moment
        lost_ = lost_ || !world_.power[s];
    }
    void disturb() {
        auto& faults = (once_in(2) ? bus_.transport : *bus_.second).faults;
        const std::uint32_t few = 1 + random_() % 4;
        ++counts_["disturbed"];
        noise_left_ = 400;
        switch (random_() % 6) {
            case 0: faults.drop_requests = few; break;
            case 1: faults.drop_answers = few; break;
            case 2: faults.delay_answers = few, faults.delay = std::chrono::microseconds{200 + random_() % 4000}; break;
            case 3: faults.delay_answers = 1, faults.delay = std::chrono::milliseconds{random_() % 200}; break;
            case 4: faults.duplicate_answers = few; break;
            default: faults.reorder_answers = few;
        }
    }
    void settle(int cycles) {
        for (int i = 0; i < cycles && wrong_.empty(); ++i) bus_.cycle_once();
    }

    // --- what must hold -------------------------------------------------------------------------------------------------------------

    void look() {
        ++cycle_;
        ++since_event_;
        if (noise_left_ > 0 && --noise_left_ == 0)
            for (auto* end : {&bus_.transport, bus_.second.get()}) end->faults = {};  // what found no frame to disturb
        const auto facts = bus_.facts();
        for (std::size_t s = 0; s < slaves_.size(); ++s) look_at(s, facts);
        look_at_data();
        if (watching_) look_at_bus(facts);
    }
    /// Rightly told: it has lost its link, and no frame has met that.
    [[nodiscard]] bool loose_plug(const AlarmFact& fact) const {
        return fact.id == id(BusAlarm::cable_loses_link) && blinked_[fact.index + (fact.b == 0 ? 0u : 1u)];
    }
    void look_at(std::size_t s, const std::vector<AlarmFact>& facts) {
        auto& slave = slaves_[s];
        const auto& health = bus_.master->health(s);
        // A group is named at its first slave until the last of it is back.
        const bool others_away = std::any_of(slaves_.begin(), slaves_.end(), [](const Watched& other) { return other.excused; });
        const bool accused = std::any_of(facts.begin(), facts.end(), [&](const AlarmFact& fact) {
            if (fact.id == id(BusAlarm::cable_broken) && others_away) return false;
            if (loose_plug(fact)) return false;
            return fact.source == AlarmSource::slave && fact.index == s && fact.id != id(BusAlarm::cut_off_from_reference);
        });
        if (!world_.reached(s)) slave.excused = true;
        const bool well = world_.reached(s) && health.fresh && !accused && bus_.network.slave(s).state() == sim::EsmState::op;
        slave.well_for = well ? slave.well_for + 1 : 0;
        if (slave.well_for > 300) slave.excused = false;
        slave.stale_for = health.fresh ? 0 : slave.stale_for + 1;
        const auto missed = bus_.network.slave(s).missed_outputs();
        const auto new_missed = missed - std::min(missed, slave.missed);
        slave.missed = missed;
        if (!watching_ || slave.excused || noise_left_ > 0) return;
        if (accused) complain(fmt::format("slave {} was never away and is accused", s));
        if (new_missed > 0 && since_event_ > 3) complain(fmt::format("slave {} missed outputs without an event", s));
        if (new_missed > 2) complain(fmt::format("slave {} missed {} outputs at once", s, new_missed));
        if (slave.stale_for > 3) complain(fmt::format("slave {} is reached and not exchanged for {} cycles", s, slave.stale_for));
        if (slave.stale_for > 0 && since_event_ > 3) complain(fmt::format("slave {} is reached and not exchanged", s));
        if (slave.stale_for > 1 && since_event_ == 3) ++counts_["two cycles"];
        if (!ramp_down_ && devices_[s] == 's') look_at_clock(s);
    }
    void look_at_clock(std::size_t s) {
        const auto ref = bus_.master->bus().reference;
        // The clock of one that was away is pulled to the reference's, and theirs to that of a reference that was.
        constexpr int pulled = 3000;
        if (!ref || slaves_[*ref].well_for < pulled || slaves_[s].well_for < pulled) return;
        const auto error =
            bus_.network.slave(s).controller().clock().system(bus_.now) - bus_.network.slave(*ref).controller().clock().system(bus_.now);
        worst_clock = std::max(worst_clock, std::abs(error));
        if (std::abs(error) > 3000) complain(fmt::format("the clock of slave {} is {} ns from the reference", s, error));
    }
    /// What comes back is what was sent a moment before, never something older than what came before.
    void look_at_data() {
        ++value_;
        for (std::size_t s = 0; s < slaves_.size(); ++s) {
            if (devices_[s] != 's') continue;
            auto& slave = slaves_[s];
            if (bus_.master->health(s).fresh) {
                const auto in = load_le<std::int32_t>(bus_.master->inputs(), slave.input);
                if (!slave.excused && watching_) {
                    if (in < slave.seen) complain(fmt::format("slave {} shows {} after {}", s, in, slave.seen));
                    if (value_ - in > 5 && noise_left_ == 0) complain(fmt::format("slave {} shows {}, and was told {}", s, in, value_ - 1));
                    if (in >= value_) complain(fmt::format("slave {} shows {} before it was told so", s, in));
                }
                slave.seen = in;
            }
            store_le(bus_.master->outputs(), slave.output, value_);
        }
    }
    void look_at_bus(const std::vector<AlarmFact>& facts) {
        const bool closed = world_.closed();
        changed_for_ = closed == was_closed_ ? changed_for_ + 1 : 0;
        was_closed_ = closed;
        bool anybody_away = false, all_away = true, anybody_excused = false;
        for (std::size_t s = 0; s < slaves_.size(); ++s) {
            anybody_away = anybody_away || !world_.reached(s);
            all_away = all_away && !world_.reached(s);
            anybody_excused = anybody_excused || slaves_[s].excused;
        }
        bool said = false;
        for (const auto& fact : facts) {
            const auto is = [&](BusAlarm alarm) { return fact.id == id(alarm); };
            if (is(BusAlarm::ring_broken)) said = true;
            else if (is(BusAlarm::cut_off_from_reference)) look_at_cut_off(fact.index);
            else if (is(BusAlarm::dc_out_of_sync)) continue;  // says what is being mended; that it ends is seen at the end
            else if (fact.source == AlarmSource::bus && !anybody_excused && noise_left_ == 0)
                complain(fmt::format("alarm {:x} although all are reached", fact.id));
        }
        if (noise_left_ > 0 || since_event_ < 6 || changed_for_ < 6 || all_away) return;
        if (said == closed) complain(said ? "the ring is said to be broken" : "the ring is not said to be broken");
        if (said && world_.all_powered() && world_.broken_cables() == 1) look_at_place(facts);
    }
    void look_at_cut_off(std::size_t s) {
        const auto ref = bus_.master->bus().reference;
        if (!ref || noise_left_ > 0 || since_event_ < 6 || slaves_[s].excused) return;
        if (world_.together(*ref, s)) complain(fmt::format("slave {} is said to be cut off from the reference", s));
    }
    void look_at_place(const std::vector<AlarmFact>& facts) {
        std::size_t c = 0;
        while (world_.cable[c]) ++c;
        for (const auto& fact : facts) {
            if (fact.id != id(BusAlarm::ring_broken)) continue;
            const auto text = bus_.master->detail(fact);
            const auto name = [&](std::size_t s) { return fmt::format("slave {} '", s); };
            const bool before = c == 0 ? text.find("first interface") != text.npos : text.find(name(c - 1)) != text.npos;
            const bool behind = c == devices_.size() ? text.find("second interface") != text.npos : text.find(name(c)) != text.npos;
            if ((!before || !behind) && since_event_ > 12) complain(fmt::format("cable {} is out, and named is '{}'", c, text));
        }
    }

    void come_back() {
        tell("all healed");
        quiet_ = 0;
        for (auto* end : {&bus_.transport, bus_.second.get()}) end->faults = {};
        for (std::size_t c = 0; c < world_.cable.size(); ++c) bus_.set_ring_cable(c, true);
        for (std::size_t s = 0; s < world_.power.size(); ++s) bus_.network.set_power(s, true);
        world_ = RingWorld{devices_.size()};
        since_event_ = 0;
        const auto well = [&] {
            for (std::size_t s = 0; s < slaves_.size(); ++s)
                if (!bus_.master->health(s).fresh || bus_.network.slave(s).state() != sim::EsmState::op) return false;
            const auto facts = bus_.facts();
            return std::all_of(facts.begin(), facts.end(), [&](const AlarmFact& fact) { return loose_plug(fact); });
        };
        if (!bus_.run_until([&] { return !wrong_.empty() || well(); }, std::chrono::seconds{20})) {
            complain("not all come back although nothing is broken any more");
            for (std::size_t s = 0; s < slaves_.size(); ++s)
                wrong_ += fmt::format("  slave {} is {} fresh {} address {:x}\n", s, static_cast<int>(bus_.network.slave(s).state()),
                                      bus_.master->health(s).fresh, bus_.network.slave(s).controller().station_address());
        }
        bus_.run_for(std::chrono::milliseconds{500});
        for (std::size_t s = 0; s < slaves_.size(); ++s)
            if (bus_.network.slave(s).controller().station_address() != station_at(static_cast<std::uint16_t>(s)))
                complain(fmt::format("slave {} has another address", s));
        if (!bus_.run_until(well, std::chrono::seconds{10})) complain("not well any more");  // a clock may still be pulled
        ++counts_["came back"];
    }

public:
    std::int64_t worst_clock = 0;

private:
    std::mt19937 random_;
    RingWalkCounts& counts_;
    std::string devices_;
    TestBus bus_;
    RingWorld world_;
    bool ramp_down_ = false, noisy_ = false, watching_ = false, lost_ = false, was_closed_ = true;
    std::vector<Watched> slaves_;
    std::vector<int> broken_in_;  // by cable: the cycle
    std::vector<bool> blinked_;   // and whole again before any frame met it: a loose plug, and told as one
    int cycle_ = 0, since_event_ = 1000, quiet_ = 300, noise_left_ = 0, changed_for_ = 1000;
    std::int32_t value_ = 0;
    std::string wrong_, log_;
};

TEST(RingWalks, CostWhatWasUnderWayAndAccuseNobodyWhoWasNeverAway) {
    RingWalkCounts counts;
    std::int64_t worst = 0;
    const auto walked = taktwerk::test::walk_seeds(
        40, 6000, [&](unsigned seed) { return RingWalk(seed, counts); },
        [&](RingWalk& walk) { worst = std::max(worst, walk.worst_clock); });
    for (const auto& [what, count] : counts) std::printf("%s %ld\n", what.c_str(), count);
    std::printf("worst clock %ld ns\n", static_cast<long>(worst));
    if (walked.one_alone || HasFailure()) return;
    for (const auto* what : {"broken", "healed", "two breaks", "on", "off", "disturbed", "came back"}) EXPECT_GE(counts[what], 1) << what;
}

}  // namespace
}  // namespace taktwerk::ecat::test
