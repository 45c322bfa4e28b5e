#include "ecat/bringup/hot_connect.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/cable_survey.hpp"
#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/guests.hpp"
#include "ecat/bringup/recovery.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/sii_reader.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration glance = std::chrono::milliseconds{5};
constexpr Duration settled = std::chrono::milliseconds{20};  ///< so long the number of slaves stays before they are looked at: plugs bounce
constexpr Duration first_retry = std::chrono::milliseconds{500};
constexpr Duration longest_retry = std::chrono::seconds{8};

/// Somebody who stands where nobody of the bring-up does, and who it says it is.
struct Newcomer {
    FoundSlave found;
    std::uint16_t station = 0;  ///< its own until it joins
    bool taken = false;         ///< it belongs to a group
};

Error group_error(const Bus& bus, const HotConnectGroup& group, std::string what, std::string remedy) {
    return Error{"bus.hot_connect", bus.slaves[group.slaves.front()]->subject, std::move(what), std::move(remedy)};
}

/// Whatever it was set up for before, perhaps by another controller: it takes part in nothing any more.
Script<Result<void>> begin_anew(Bus& bus, BusSlave& slave) {
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    const Result<void> down = co_await set_state(bus, slave, AlState::init);
    if (!down) co_return down;
    for (unsigned n = 0; n < slave.found.fmmus; ++n)
        co_await bus.port.fpwr(slave.found.station, reg::fmmu_at(n), std::vector<std::byte>(Fmmu::size));
    for (unsigned n = 0; n < slave.found.sync_managers; ++n)
        co_await bus.port.fpwr(slave.found.station, reg::sync_manager_at(n), std::vector<std::byte>(SyncManager::size));
    co_return Result<void>{};
}

class GroupWatch {
public:
    explicit GroupWatch(Bus& bus) : bus_(bus), tries_(bus.groups.size()) {}
    Script<void> run();

private:
    /// Of one group: when it is tried again.
    struct Try {
        Instant next{};
        Duration pause = first_retry;
    };
    Script<void> look();
    Script<Result<void>> question(std::vector<Newcomer>& newcomers);
    Script<void> serve(std::size_t number, std::vector<Newcomer>& newcomers);
    Script<Result<void>> join(const HotConnectGroup& group, std::vector<Newcomer*> members);
    [[nodiscard]] Result<std::vector<Newcomer*>> members_of(const HotConnectGroup& group, std::vector<Newcomer>& newcomers) const;
    void said(std::size_t number, const Result<void>& outcome, Instant now);
    void tell_strangers(const std::vector<Newcomer>& newcomers);
    [[nodiscard]] bool retry_due(Instant now) const;

    Bus& bus_;
    std::vector<Try> tries_;
    /// Different from those that others may have kept from the looks before.
    [[nodiscard]] std::uint16_t next_station() noexcept {
        constexpr std::uint16_t first = 0x3000, last = 0x3FFF;
        station_ = station_ == last ? first : static_cast<std::uint16_t>(station_ + 1);
        return station_;
    }

    std::uint16_t count_ = 0;
    std::uint16_t station_ = 0x3000;
    Instant changed_{};
    bool looked_ = false;
    CableSurvey survey_;
};

Script<void> GroupWatch::run() {
    changed_ = co_await time();
    for (;;) {
        const Instant now = co_await pause(glance);
        if (bus_.link.lost_in_a_row.load() != 0 || bus_.link.cycles.load() == 0) continue;
        // Pulled and plugged in between two glances it is as many as before.
        if (const auto answering = bus_.link.slaves_answering.load(); answering != count_ || bus_.group_left) {
            bus_.group_left = false;
            count_ = answering;
            changed_ = now;
            looked_ = false;
            bus_.groups_at_rest = false;
            for (auto& one : tries_) one = {};
        }
        if (looked_ ? !retry_due(now) : now - changed_ < settled) continue;
        co_await look();
        bus_.groups_at_rest = looked_;
    }
}

bool GroupWatch::retry_due(Instant now) const {
    return std::any_of(bus_.groups.begin(), bus_.groups.end(), [&](const HotConnectGroup& group) {
        const auto& head = *bus_.slaves[group.slaves.front()];
        return !head.last_trouble.empty() && head.away() && now >= tries_[static_cast<std::size_t>(&group - bus_.groups.data())].next;
    });
}

Script<void> GroupWatch::look() {
    looked_ = true;
    const Result<void> known = co_await survey_.take(bus_);
    if (!known || survey_.size() != count_) {
        looked_ = false;  // it changed meanwhile
        changed_ = co_await time();
        co_return;
    }
    std::vector<Newcomer> newcomers;
    for (const std::uint16_t position : survey_.newcomers()) newcomers.emplace_back().found.position = position;
    const Result<void> asked = co_await question(newcomers);
    if (!asked) {
        looked_ = false;
        changed_ = co_await time();
        co_return;
    }
    bus_.link.line.guests.store(survey_.guests());  // not before they take part in nothing
    for (std::size_t number = 0; number < bus_.groups.size(); ++number) co_await serve(number, newcomers);
    tell_strangers(newcomers);
    const Result<void> measured = co_await survey_.measure_delays(bus_);
    if (!measured) bus_.remember(measured.error().text());
}

/// Who they are. Each gets an address of its own, and keeps it until it joins or is left alone.
Script<Result<void>> GroupWatch::question(std::vector<Newcomer>& newcomers) {
    const bool wants_id = std::any_of(bus_.groups.begin(), bus_.groups.end(), [&](const HotConnectGroup& group) {
        return bus_.config.slaves[group.slaves.front()].device_id.has_value();
    });
    for (auto& one : newcomers) {
        one.station = next_station();
        const Result<void> given = co_await survey_.give_address(bus_, one.found.position, one.station);
        if (!given) co_return given;
        // Who was set up by another controller and kept its power takes part in nothing any more.
        const Reply unmapped = co_await bus_.port.fpwr(one.station, reg::fmmu, std::vector<std::byte>(16 * Fmmu::size));
        if (unmapped.lost) co_return unanswered("bus", "its FMMUs (0600h)", unmapped);
    }
    for (auto& one : newcomers) {
        const std::uint16_t position = one.found.position;
        const std::string subject = fmt::format("the slave at place {} of the cable", position);
        one.found = co_await read_slave(bus_.port, position, one.station, subject);
        if (!one.found.error && wants_id) {
            Result<Sii> sii = co_await read_whole_sii(bus_.port, one.station, subject);
            if (sii) one.found.sii = std::move(*sii);
            one.found.device_id = co_await read_device_id(bus_.port, one.station, id_register(one.found.sii));
        }
        if (one.found.error && (one.found.error->code == "bus.no_slave" || one.found.error->code == "bus.no_frame"))
            co_return *one.found.error;
    }
    co_return Result<void>{};
}

Result<std::vector<Newcomer*>> GroupWatch::members_of(const HotConnectGroup& group, std::vector<Newcomer>& newcomers) const {
    const auto& head = bus_.config.slaves[group.slaves.front()];
    std::vector<std::size_t> heads;
    for (std::size_t i = 0; i < newcomers.size(); ++i)
        if (is_head(head, newcomers[i].found)) heads.push_back(i);
    for (const std::size_t at : heads) {
        newcomers[at].taken = true;
        for (std::size_t n = 1; n < group.slaves.size() && at + n < newcomers.size(); ++n) {
            const auto& found = newcomers[at + n].found;
            if (!check_identity({}, bus_.config.slaves[group.slaves[n]], found.identity)) break;
            newcomers[at + n].taken = true;
        }
    }
    const std::string number = head.alias ? fmt::format("alias {}", *head.alias) : fmt::format("device id {}", head.device_id.value_or(0));
    const bool there = !bus_.slaves[group.slaves.front()]->away();
    if (heads.size() + (there ? 1 : 0) > 1)
        return group_error(bus_, group,
                           there ? fmt::format("it is in operation, and another slave with {} was plugged in at place {} of the cable",
                                               number, newcomers[heads[0]].found.position)
                                 : fmt::format("{} is set in two slaves, at places {} and {} of the cable", number,
                                               newcomers[heads[0]].found.position, newcomers[heads[1]].found.position),
                           "unplug one of them, or give it another number and power-cycle it");
    std::vector<Newcomer*> members;
    if (heads.empty()) return members;
    std::optional<Error> wrong;
    for (std::size_t n = 0; n < group.slaves.size(); ++n) {
        const auto& slave = *bus_.slaves[group.slaves[n]];
        const std::size_t at = heads[0] + n;
        const bool next =
            at < newcomers.size() && !newcomers[at].found.error && newcomers[at].found.position == newcomers[heads[0]].found.position + n;
        if (!next)
            return group_error(
                bus_, group,
                fmt::format("{} of its {} slaves are there: behind '{}' stands nobody, where '{}' ({}) is configured", n,
                            group.slaves.size(), bus_.config.slaves[group.slaves[n - 1]].name, slave.config->name, slave.device().name),
                "check its power and its cable inside the group");
        if (const auto identity = check_identity(slave.subject, *slave.config, newcomers[at].found.identity); !identity) {
            if (n > 0) newcomers[at].taken = true;
            return identity.error();
        }
        newcomers[at].taken = true;
        members.push_back(&newcomers[at]);
    }
    return members;
}

Script<void> GroupWatch::serve(std::size_t number, std::vector<Newcomer>& newcomers) {
    const auto& group = bus_.groups[number];
    const auto members = members_of(group, newcomers);
    const Instant began = co_await time();
    if (!members) {
        said(number, members.error(), began);
        co_return;
    }
    if (members->empty()) {
        said(number, Result<void>{}, began);
        co_return;
    }
    for (const std::size_t slave : group.slaves) bus_.slaves[slave]->link.attendance.store(Attendance::joining);
    Result<void> done = co_await join(group, *members);
    const Instant now = co_await time();
    for (const std::size_t slave : group.slaves) bus_.slaves[slave]->link.attendance.store(done ? Attendance::there : Attendance::away);
    if (done) {
        bus_.remember(fmt::format("group '{}' has joined at place {} of the cable, in {} ms", group.name, members->front()->found.position,
                                  (now - began) / std::chrono::milliseconds{1}));
    } else {
        for (const std::size_t slave : group.slaves) bus_.slaves[slave]->mailbox.station = 0;
        // Pulled out again on its way: the count of slaves says so.
        const bool gone = done.error().code == "bus.no_slave" || done.error().code == "bus.no_frame";
        if (gone) done = Result<void>{};
        looked_ = looked_ && !gone;
        changed_ = gone ? now : changed_;
    }
    said(number, done, now);
}

Script<Result<void>> GroupWatch::join(const HotConnectGroup& group, std::vector<Newcomer*> members) {
    for (std::size_t n = 0; n < members.size(); ++n) {
        const auto& slave = *bus_.slaves[group.slaves[n]];
        const Reply given = co_await bus_.port.fpwr(members[n]->station, reg::station_address, slave.found.station);
        if (!given.ok()) co_return unanswered(slave.subject, "its station address (0010h)", given);
    }
    for (std::size_t n = 0; n < members.size(); ++n) {
        auto& slave = *bus_.slaves[group.slaves[n]];
        const std::uint16_t station = slave.found.station;
        slave.found = members[n]->found;
        slave.found.position = not_on_the_cable;
        slave.found.station = station;
        slave.identified = true;
        slave.dc = (slave.found.features & feature::dc) != 0;
        survey_.take_for(members[n]->found.position, slave);
        slave.link.presence.store(Presence::answers);
        slave.link.trouble.store(ReturnTrouble::none);
        slave.link.attempts.store(0);
        const Result<void> anew = co_await begin_anew(bus_, slave);
        if (!anew) co_return anew;
    }
    const Result<void> measured = co_await survey_.measure_delays(bus_);
    if (!measured) co_return measured;
    for (const std::size_t index : group.slaves) {
        auto& slave = *bus_.slaves[index];
        const auto& plan = bus_.plan.slaves[slave.index];
        if (plan.fmmus.size() > slave.found.fmmus)
            co_return Error{"bus.plan.too_many_fmmus", slave.subject,
                            fmt::format("its controller has {} FMMUs, its process data needs {}", slave.found.fmmus, plan.fmmus.size()),
                            "state `fmmus` in its description as the device has them"};
        if ((slave.found.features & feature::no_lrw) != 0 && !plan.fmmus.empty())
            co_return Error{"bus.hot_connect", slave.subject, "its controller does not execute LRW, which groups are exchanged by",
                            "list it among the slaves that are always there"};
        const Result<void> done = co_await recover(bus_, slave);
        if (!done) co_return done;
    }
    co_return Result<void>{};
}

/// What is known of a group's trouble, and when it is tried again.
void GroupWatch::said(std::size_t number, const Result<void>& outcome, Instant now) {
    auto& head = *bus_.slaves[bus_.groups[number].slaves.front()];
    const std::string text = outcome ? std::string{} : outcome.error().text();
    if (!text.empty() && text != head.last_trouble) bus_.remember(text);
    head.last_trouble = text;
    head.link.seen.say<BusAlarm::group_does_not_join>(!text.empty());
    auto& attempt = tries_[number];
    if (text.empty()) {
        attempt = {};
        return;
    }
    attempt.next = now + attempt.pause;
    attempt.pause = std::min(2 * attempt.pause, longest_retry);
}

void GroupWatch::tell_strangers(const std::vector<Newcomer>& newcomers) {
    std::string text;
    for (const auto& one : newcomers)
        if (!one.taken)
            text += fmt::format("{}at place {} of the cable: {}", text.empty() ? "" : "; ", one.found.position, found_text(one.found));
    const bool told = bus_.config.extra_slaves == ExtraSlaves::refuse;
    if (told && !text.empty() && text != bus_.strangers) bus_.remember("a slave that belongs to no group was plugged in " + text);
    bus_.strangers = told ? text : std::string{};
    bus_.link.seen.say<BusAlarm::stranger_plugged_in>(!bus_.strangers.empty());
}

}  // namespace

void leave(Bus& bus, BusSlave& slave) {
    const auto group = std::find_if(bus.groups.begin(), bus.groups.end(),
                                    [&](const HotConnectGroup& one) { return one.name == slave.config->hot_connect; });
    if (group == bus.groups.end()) return;
    for (const std::size_t index : group->slaves) {
        auto& member = *bus.slaves[index];
        member.link.attendance.store(Attendance::away);
        member.link.al.store(0);
        member.link.sync0_start.store(0);
        member.link.presence.store(Presence::answers);
        member.link.trouble.store(ReturnTrouble::none);
        member.link.taken_down.store(false);
        member.link.cable.store({});
        member.link.seen.say<BusAlarm::mailbox_silent>(false);
        member.dc_difference = 0;
        member.mailbox.reset();
        member.mailbox.station = 0;
        member.last_trouble.clear();
        member.not_exchanged.clear();
    }
    const auto gone = std::min<std::size_t>(group->slaves.size(), bus.link.line.guests.load());
    bus.link.line.guests.fetch_sub(static_cast<std::uint16_t>(gone));
    bus.group_left = true;
    bus.remember(fmt::format("group '{}' has left: {} does not answer any more", group->name, slave.subject));
}

Script<void> watch_groups(Bus& bus) {
    if (bus.groups.empty()) co_return;
    GroupWatch watch{bus};
    co_await watch.run();
}

}  // namespace taktwerk::ecat
