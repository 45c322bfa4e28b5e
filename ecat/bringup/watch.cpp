#include "ecat/bringup/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/cable_watch.hpp"
#include "ecat/bringup/hot_connect.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/recovery.hpp"
#include "ecat/bringup/reference_role.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/dc/propagation.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration watch_period = std::chrono::milliseconds{100};
/// So many cycles' share of datagrams a round of the watch takes at most from SDOs and recoveries: half of them.
constexpr std::int64_t watch_share = 2;
constexpr Duration watch_glance = std::chrono::milliseconds{5};       ///< how soon a state the cycle saw is noticed
constexpr Duration watch_suspicious = std::chrono::milliseconds{20};  ///< instead of watch_period, when the cycle sees something new
constexpr Duration difference_period = std::chrono::seconds{1};
constexpr Duration settings_period = std::chrono::seconds{1};  ///< between two looks at the settings of a slave that does not exchange
constexpr Duration first_retry = std::chrono::milliseconds{500};
constexpr Duration longest_retry = std::chrono::seconds{8};
constexpr Duration lasting = std::chrono::seconds{10};             ///< so long in OP, and its earlier falls are forgotten
constexpr Duration least_census = std::chrono::milliseconds{100};  ///< between two
constexpr Duration slow_census = std::chrono::seconds{2};          ///< while somebody is missing and the count stays
constexpr Duration mailbox_period = std::chrono::seconds{5};
constexpr Duration foreign_window = std::chrono::seconds{1};
constexpr std::uint64_t foreign_in_window = 3;  ///< frames a window: fewer may be our own with a bit flipped in the address
constexpr auto in_op = static_cast<std::uint32_t>(AlState::op);

/// When to try again: at once the first time, then after ever longer pauses, until the slave has stayed in OP for a while.
class BackOff {
public:
    [[nodiscard]] bool due(Instant now) const noexcept { return now >= next_; }
    void tried(Instant now) noexcept {
        next_ = now + pause_;
        pause_ = std::min(2 * pause_, longest_retry);
    }
    void healthy(Instant now) noexcept {
        if (now - next_ >= lasting) forget();
    }
    void forget() noexcept {
        next_ = Instant{};
        pause_ = first_retry;
    }

private:
    Instant next_ = Instant{};
    Duration pause_ = first_retry;
};

Presence presence_of(const Result<std::uint16_t>& status) {
    if (status) return Presence::answers;
    return status.error().code == "bus.no_frame" ? Presence::unheard : Presence::silent;
}

Script<void> ask_difference(Bus& bus, BusSlave& slave) {
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::dc_difference, 4);
    if (reply.ok()) slave.dc_difference = std::abs(static_cast<std::int64_t>(dc_difference_ns(reply.u32())));
}

/// When one clock is off, all are asked before it is said: whether the others are off as well tells whose clock it is.
Script<void> read_difference(Bus& bus, BusSlave& slave) {
    const bool was_off = slave.dc_difference > clock_is_off_ns;
    co_await ask_difference(bus, slave);
    if (!was_off && slave.dc_difference > clock_is_off_ns) {
        std::vector<Script<void>> scripts;
        for (const auto& other : bus.slaves)
            if (other->dc && other.get() != &slave && other->link.presence.load() == Presence::answers)
                scripts.push_back(ask_difference(bus, *other));
        co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    }
    if (bus.reference) bus.slaves[*bus.reference]->dc_difference = 0;  // its register holds what it was before it served
    std::int64_t worst = 0;
    for (const auto& other : bus.slaves) worst = std::max(worst, other->dc_difference);
    bus.link.dc_difference_ns.store(worst);
}

/// The least time between two looks at one slave, so that looking at all of them leaves room for others.
Duration round_of_watch(const Bus& bus) {
    return watch_share * static_cast<std::int64_t>(bus.slaves.size()) * bus.config.cycle / bus.config.acyclic_per_cycle;
}

std::string fall_text(const Bus& bus, const BusSlave& slave, const Result<std::uint16_t>& status, Instant now) {
    // Why, the alarm says, when all who are missing are known: who stands behind a broken cable has power and cable.
    if (presence_of(status) == Presence::silent) return fmt::format("{} does not answer", slave.subject);
    if (!status) return status.error().text();
    const auto code = static_cast<std::uint16_t>(slave.link.al.load() >> 16);
    if ((*status & al_status_error) == 0 && code == 0) {
        const std::string heard = bus.link.foreign_frames.load() > 0 ? "; of whom frames were heard: " + sender_text(bus.link) : "";
        return fmt::format(
            "{} is in {} without an error of its own: somebody else sent it there (another master, a tool), or it restarted{}",
            slave.subject, name(al_state(*status)), heard);
    }
    std::string text = fmt::format("{} left OP: it is in {}, AL status code {:04X}h {}", slave.subject, name(al_state(*status)), code,
                                   al_status_info(code).text);
    if (const Duration stall = recent_stall(bus.link, now); stall > Duration{})
        text += fmt::format("; right before, this computer sent nothing for {:.4g} ms", to_seconds(stall) * 1e3);
    return text;
}

/// One slave: is it in OP with its own settings? If not, back to OP.
class SlaveWatch {
public:
    SlaveWatch(Bus& bus, BusSlave& slave) : bus_(bus), slave_(slave) {}
    Script<void> run();

private:
    Script<void> look_after(Instant now);
    Script<void> check_settings(Instant now);
    Script<void> bring_back();

    Bus& bus_;
    BusSlave& slave_;
    BackOff back_off_;
    bool reported_ = false;
    Instant difference_at_{}, settings_at_{};
};

Script<void> SlaveWatch::run() {
    Instant looked = co_await time();
    const Duration round = round_of_watch(bus_);
    std::uint64_t picture = 0;
    for (;;) {
        const Instant now = co_await pause(watch_glance);
        const std::uint64_t seen = bus_.link.states_seen.load() | (std::uint64_t{bus_.link.slaves_answering.load()} << 32);
        if (now - looked < std::max(round, seen != picture ? watch_suspicious : watch_period)) continue;
        looked = now;
        picture = seen;
        if (slave_.away()) {
            reported_ = false;
            back_off_.forget();
            continue;
        }

        const unsigned holds = bus_.address_holds;
        const Result<std::uint16_t> status = co_await read_al_status(bus_, slave_);
        if (!status && (holds > 0 || bus_.address_holds > 0)) continue;
        const Presence presence = presence_of(status);
        if (slave_.away()) continue;  // another of its group was found missing meanwhile
        if (presence == Presence::silent && slave_.config->guest()) {
            leave(bus_, slave_);
            continue;
        }
        if (presence != slave_.link.presence.exchange(presence)) {
            back_off_.forget();
            slave_.position_now.reset();  // where it was says nothing about where it is, or who it is
            if (presence == Presence::silent) slave_.identified = false;
            bus_.census_wanted = bus_.census_wanted || presence == Presence::silent;
        }
        // Without its address a slave still exchanges, and the broadcast says that everybody is in OP: its axes need not stop.
        const bool known_in_op =
            bus_.link.states_seen.load() == in_op && bus_.link.lost_in_a_row.load() == 0 && slave_.link.age.load() == 0;
        // Where no frame came back nothing is known: its state is what it was, for as long as the machine bears lost frames.
        const bool bearable = presence == Presence::unheard && bus_.link.lost_in_a_row.load() < bus_.config.lost_frames_limit;
        if (!status && !known_in_op && !bearable) slave_.link.al.store(0);
        if (presence == Presence::unheard) continue;
        if (status && *status == in_op) {
            co_await look_after(now);
            continue;
        }
        if (!reported_) bus_.remember(fall_text(bus_, slave_, status, now));
        reported_ = true;
        if (presence == Presence::silent && !slave_.position_now) continue;
        if (back_off_.due(now)) co_await bring_back();
    }
}

Script<void> SlaveWatch::look_after(Instant now) {
    reported_ = false;
    back_off_.healthy(now);
    slave_.link.trouble.store(ReturnTrouble::none);
    slave_.link.taken_down.store(false);
    slave_.link.attempts.store(0);
    if (slave_.dc && bus_.reference != slave_.index && now - difference_at_ >= difference_period) {
        difference_at_ = now;
        co_await read_difference(bus_, slave_);
    }
    co_await check_settings(now);
}

/// In OP and not exchanged, although frames come back: somebody else may have written its sync managers or FMMUs.
Script<void> SlaveWatch::check_settings(Instant now) {
    const bool stale = slave_.link.age.load() > 0 && bus_.link.lost_in_a_row.load() == 0;
    if (!stale || now - settings_at_ < settings_period) co_return;
    settings_at_ = now;
    const Result<std::string> changed = co_await changed_setting(bus_, slave_);
    if (!changed) co_return;
    if (changed->empty()) {
        slave_.not_exchanged = "it is in OP, and its sync managers and FMMUs are as they were written";
        co_return;
    }
    slave_.not_exchanged = *changed + " is not as it was written: something wrote to it";
    bus_.remember(slave_.subject + ": " + slave_.not_exchanged + "; it is set up again");
    slave_.link.taken_down.store(true);
    const Reply down = co_await bus_.port.fpwr(slave_.found.station, reg::al_control, static_cast<std::uint16_t>(AlState::init));
    if (!down.ok()) co_return;
    slave_.link.al.store(static_cast<std::uint32_t>(AlState::init));
    co_await bring_back();
}

Script<void> SlaveWatch::bring_back() {
    const Result<void> back = co_await recover(bus_, slave_);
    const Instant now = co_await time();
    back_off_.tried(now);
    slave_.link.attempts.fetch_add(1);
    if (back) {
        slave_.link.recoveries.fetch_add(1);
        slave_.link.attempts.store(0);
        slave_.link.trouble.store(ReturnTrouble::none);
        slave_.last_trouble.clear();
        bus_.remember(slave_.subject + " is back in OP");
        reported_ = false;
        co_return;
    }
    const Error& error = back.error();
    if (slave_.last_trouble != error.text()) bus_.remember(error.text());
    slave_.last_trouble = error.text();
    if (error.code == "bus.wrong_identity") slave_.link.trouble.store(ReturnTrouble::other_device);
    else if (error.code != "bus.no_frame" && error.code != "bus.no_slave") slave_.link.trouble.store(ReturnTrouble::refused);
    if (error.code == "bus.no_slave" || error.code == "bus.wrong_place") {
        slave_.position_now.reset();
        bus_.census_wanted = true;
    }
}

Script<void> watch_slave(Bus& bus, BusSlave& slave) {
    SlaveWatch watch{bus, slave};
    co_await watch.run();
}

/// Where everybody is, again whenever the cycle counts another number of slaves or somebody is missed.
Script<void> watch_places(Bus& bus) {
    Instant taken = co_await time();
    for (;;) {
        const Instant now = co_await pause(watch_glance);
        if (bus.link.lost_in_a_row.load() != 0 || bus.link.cycles.load() == 0) continue;
        const bool changed = bus.link.slaves_answering.load() != bus.counted;
        const bool missing = std::any_of(bus.slaves.begin(), bus.slaves.end(),
                                         [](const auto& s) { return s->link.presence.load() == Presence::silent && !s->position_now; });
        const bool due = (changed || bus.census_wanted) ? now - taken >= least_census : missing && now - taken >= slow_census;
        if (!due) continue;
        taken = now;
        co_await take_census(bus);
    }
}

/// Asks a slave for an object that every CoE device has; one slave at a time, a few datagrams in some seconds.
Script<void> ask_mailbox(Bus& bus, BusSlave& slave) {
    const Result<std::vector<std::byte>> type = co_await sdo_upload(bus.port, slave.mailbox, 0x1000, 0);
    const bool spoke = type.ok() || type.error().code == "sdo.abort";
    const bool mute = !spoke && type.error().code.starts_with("sdo.");  // bus.*: the slave or the frames are away
    if (mute && !slave.link.seen.say<BusAlarm::mailbox_silent>(true))
        bus.remember(slave.subject + " does not answer in its mailbox: " + type.error().what);
    if (spoke && slave.link.seen.say<BusAlarm::mailbox_silent>(false)) bus.remember(slave.subject + " answers in its mailbox again");
}

Script<void> watch_mailboxes(Bus& bus) {
    for (;;) {
        co_await pause(mailbox_period);
        for (auto& slave : bus.slaves) {
            if (!slave->has_coe() || slave->link.al.load() != in_op || bus.link.lost_in_a_row.load() != 0) continue;
            co_await ask_mailbox(bus, *slave);
        }
    }
}

/// Said as soon as there are enough of them; gone when none came for a while.
Script<void> watch_senders(Bus& bus) {
    std::uint64_t seen = bus.link.foreign_frames.load(), before = seen;
    Instant window = co_await time(), heard = window;
    for (;;) {
        const Instant now = co_await pause(watch_glance);
        const std::uint64_t frames = bus.link.foreign_frames.load();
        if (frames != seen) heard = now;
        seen = frames;
        if (seen - before >= foreign_in_window && !bus.link.seen.say<BusAlarm::foreign_master>(true))
            bus.remember("frames of another EtherCAT master are on the cable: " + sender_text(bus.link));
        if (now - heard >= foreign_window) bus.link.seen.say<BusAlarm::foreign_master>(false);
        if (now - window < foreign_window) continue;
        window = now;
        before = seen;
    }
}

}  // namespace

Script<void> keep_alive(Bus& bus) {
    for (auto& slave : bus.slaves) slave->position_now = slave->found.position;
    bus.counted = bus.link.slaves_answering.load();
    std::vector<Script<void>> scripts;
    scripts.push_back(watch_reference(bus));
    for (auto& slave : bus.slaves) {
        scripts.push_back(watch_slave(bus, *slave));
        if (slave->has_coe()) scripts.push_back(listen(bus.port, slave->mailbox));
    }
    scripts.push_back(watch_places(bus));
    scripts.push_back(watch_groups(bus));
    scripts.push_back(watch_mailboxes(bus));
    scripts.push_back(watch_senders(bus));
    scripts.push_back(watch_cables(bus));
    co_await all(std::move(scripts));
}

}  // namespace taktwerk::ecat
