#include "tests/troubles/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "ecat/diagnosis/physical_remarks.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "ecat/diagnosis/why_not_op.hpp"
#include "runtime/machine/alarm_text.hpp"
#include "tests/troubles/devices.hpp"

namespace taktwerk::troubles {

using namespace ecat;

namespace {

constexpr Duration listened = 2s;

/// Holds until it is known who it is: "will be known in a moment".
bool goes_by_itself_when_known(const std::string& name) {
    return std::any_of(bus_alarms.begin(), bus_alarms.end(), [&](const AlarmInfo& info) {
        return info.name == name && info.reset == ResetRule::self_clearing && is_followed(info.id);
    });
}

Said said_of(const Error& error, Duration after = {}) { return {error.code, error.subject, error.what, error.remedy, after}; }

/// What `bus why` prints of a slave: the code with the standard's words, and the cause.
Said said_of(const WhySlave& slave, const std::string& id, Duration after) {
    std::string cause = slave.cause;
    if (slave.al_error || slave.al_code != 0) {
        const std::string code = fmt::format("AL status code {:04X}h {}", slave.al_code, al_status_info(slave.al_code).text);
        cause = cause == al_status_info(slave.al_code).text ? code : code + ": " + cause;
    }
    return {id, slave.subject, cause, slave.remedy, after};
}

std::string place_of(const Master& master, const AlarmFact& fact) {
    std::string place = "bus";
    if (fact.source == AlarmSource::slave) {
        const auto& slave = master.slave(fact.index);
        place = fmt::format("slave {} '{}' ({})", slave.position.value_or(fact.index), slave.name, slave.device->name);
    }
    const std::string more = master.detail(fact);
    return more.empty() ? place : place + ": " + more;
}

}  // namespace

Bench::Bench(std::string_view configured, std::string_view there) : TestBus("") {
    for (const char kind : configured) {
        SlaveConfig slave;
        slave.name = std::string(1, static_cast<char>('a' + config.slaves.size()));
        slave.device = device_of(kind);
        slave.position = static_cast<std::uint16_t>(config.slaves.size());
        slave.dc = slave.device->dc.required;
        if (kind == 'm') slave.modules = {{0, "csp"}, {1, "csp"}};
        config.slaves.push_back(std::move(slave));
    }
    for (const char kind : there.empty() ? configured : there)
        if (kind != ' ') plug_in(kind);
}

sim::SimSlave& Bench::plug_in(char kind, sim::SlaveOptions options) {
    options.clock_start = Duration{static_cast<std::int64_t>(network.size() + 1) * 987'654'321};
    return network.add(played(kind), model_of(kind), options);
}

void Bench::plug_in_backwards(char kind) {
    sim::SlaveOptions options;
    options.clock_start = Duration{static_cast<std::int64_t>(network.size() + 1) * 987'654'321};
    network.add_behind(network.slave(network.size() - 1), 1, played(kind), model_of(kind), options, 1);
}

BusProbe Bench::looking() {
    return BusProbe{transport, {}, [this](Duration period) {
                        now += period;
                        return std::optional{now};
                    }};
}

DeviceDescription& Bench::described(char name) {
    auto copy = std::make_shared<DeviceDescription>(*file(name).device);
    auto& own = *copy;
    file(name).device = std::move(copy);
    return own;
}

void Bench::write_startup(char name, std::uint16_t index, std::int64_t value) {
    StartupSdo sdo;
    sdo.index = index;
    sdo.value = value;
    sdo.origin = "machine.yaml:12:9";
    file(name).startup.push_back(sdo);
}

std::vector<Said> Bench::what_check_says() const {
    std::vector<Said> said;
    for (const auto& error : check(config)) said.push_back(said_of(error));
    return said;
}

std::vector<Said> Bench::wrong_links_said() {
    const Instant began = now;
    auto probe = looking();
    auto found = probe.run(survey(probe.port()));
    if (!found) return {};
    compare_with(config, *found);
    const auto wrong = probe.run(wrong_links(probe.port(), *found));
    std::vector<Said> said;
    if (wrong)
        for (const auto& error : *wrong) said.push_back(said_of(error, now - began));
    return said;
}

std::vector<Said> Bench::what_scan_says() {
    const Instant began = now;
    auto probe = looking();
    auto found = probe.run(survey(probe.port()));
    if (!found) return {said_of(found.error(), now - began)};
    compare_with(config, *found);
    std::vector<Said> said;
    for (const auto& overload : ebus_overloads(*found)) said.push_back(said_of(overload, now - began));
    for (const auto& remark : found->remarks) said.push_back(said_of(remark, now - began));
    for (const auto& slave : found->slaves)
        if (const auto& wrong = slave.found.error ? slave.found.error : slave.mismatch) said.push_back(said_of(*wrong, now - began));
    return said;
}

/// What came up all the same and is not as somebody believes stands in the notes, with the name of the slave in front.
std::vector<Said> Bench::notes_said(Instant began) const {
    std::vector<Said> said;
    for (const auto& note : master->notes()) {
        const auto colon = note.find(": "), remedy = note.rfind("; ");
        if (colon == std::string::npos || remedy == std::string::npos || remedy < colon) continue;
        said.push_back({"note", note.substr(0, colon), note.substr(colon + 2, remedy - colon - 2), note.substr(remedy + 2), now - began});
    }
    return said;
}

std::vector<Said> Bench::what_why_says() {
    std::vector<Said> said = wrong_links_said();
    const Instant began = now;
    if (bring_up()) {
        for (auto& note : notes_said(began)) said.push_back(std::move(note));
        return said;
    }
    const Duration after = now - began;
    BasicRunner<Result<WhyReport>> explaining{explain(master->bus(), master->failure())};
    for (const Instant limit = now + 5s; !explaining.done() && now < limit;) {
        cycle_once();
        explaining.step(now);
    }
    if (!explaining.done()) return said;
    const Result<WhyReport> explained = explaining.result();
    if (!explained) return said;
    const WhyReport& report = *explained;
    const auto failed = std::count_if(report.slaves.begin(), report.slaves.end(), [](const WhySlave& slave) { return slave.failed; });
    for (const auto& slave : report.slaves)
        if (slave.failed) said.push_back(said_of(slave, report.failure.code, after));
    if (failed == 0) said.push_back(said_of(report.failure, after));
    return said;
}

/// As the machine's list of alarms takes them (runtime/machine/supervisor.cpp): the newest words of each, because who it is may come some cycles
/// after that there is one; and what is known better takes the place of what was said before.
void Bench::hear(std::vector<Said>& said, Instant since) {
    const auto now_holding = facts();
    const auto holds = [&](const Said& one) {
        return std::any_of(now_holding.begin(), now_holding.end(),
                           [&](const AlarmFact& fact) { return find_alarm(bus_alarms, fact.id)->name == one.id; });
    };
    std::erase_if(said, [&](const Said& one) { return goes_by_itself_when_known(one.id) && !holds(one); });
    for (const auto& fact : now_holding) {
        if (const auto before = said_before(fact.id)) {
            const auto of_slave = fact.source == AlarmSource::slave ? fmt::format("slave {} ", fact.index) : std::string{"slave "};
            std::erase_if(said, [&](const Said& one) {
                const bool has_a_reason = one.place.find(": AL status code") != std::string::npos;
                return one.id == find_alarm(bus_alarms, ecat::id(*before))->name && one.place.starts_with(of_slave) && !has_a_reason &&
                       !holds(one);
            });
        }
        const AlarmInfo& info = *find_alarm(bus_alarms, fact.id);
        const std::string place = place_of(*master, fact);
        const auto same = [&](const Said& s) {
            return s.id == info.name && s.place.substr(0, s.place.find(':')) == place.substr(0, place.find(':'));
        };
        auto old = std::find_if(said.begin(), said.end(), same);
        if (old == said.end()) old = said.insert(said.end(), Said{std::string{info.name}, {}, {}, {}, now - since});
        old->place = place;
        old->cause = runtime::fill_in(info.english, fact.a, fact.b) + ": " + std::string{info.cause};
        old->remedy = info.remedy;
    }
}

std::vector<Said> Bench::what_alarms_say(Duration patience) {
    std::vector<Said> said;
    const Instant since = now;
    while (now - since < listened + patience) {
        cycle_once();
        hear(said, since);
    }
    return said;
}

}  // namespace taktwerk::troubles
