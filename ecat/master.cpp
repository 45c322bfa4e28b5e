#include "ecat/master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>

#include "ecat/alarms.hpp"
#include "ecat/bringup/bring_up.hpp"
#include "ecat/bringup/cable_watch.hpp"
#include "ecat/bringup/hand_over.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/watch.hpp"
#include "ecat/cycle/process_data_cycle.hpp"

namespace taktwerk::ecat {

namespace {

struct SdoJob {
    std::optional<Runner> runner;
    std::optional<Result<SdoResult>> result;
};

Script<void> run_upload(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, SdoJob& job) {
    Result<std::vector<std::byte>> data = co_await sdo_upload(bus.port, slave.mailbox, index, sub);
    if (data) job.result = SdoResult{std::move(*data)};
    else job.result = data.error();
}

Script<void> run_download(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, std::vector<std::byte> value, SdoJob& job) {
    const Result<void> written = co_await sdo_download(bus.port, slave.mailbox, index, sub, std::move(value));
    if (written) job.result = SdoResult{};
    else job.result = written.error();
}

Script<void> run_bring_up(Bus& bus, Error& failure) {
    const Result<void> done = co_await bring_up(bus);
    if (!done) {
        failure = done.error();
        co_return;
    }
    co_await keep_alive(bus);
}

Script<void> run_take_down(Bus& bus) {
    const Result<void> done = co_await take_down(bus);
    (void)done;  // what did not work stands in the notes
}

bool signed_object(const DeviceDescription& device, const MappedEntry& entry) {
    const auto it = std::find_if(device.objects.begin(), device.objects.end(),
                                 [&](const ObjectEntry& o) { return o.index == entry.index && o.sub == entry.sub; });
    return it != device.objects.end() && is_signed(it->type);
}

}  // namespace

struct Master::Impl {
    Impl(Transport& port, BusConfig configuration) : transport(port), config(std::move(configuration)), cycle(port, config) { new_bus(); }

    /// Every start has a bus of its own: the cycle may still read slaves of the one before.
    void new_bus() {
        buses.push_back(std::make_unique<Bus>(config, cycle.channel()));
        bus = buses.back().get();
        bus->publish = [this] { cycle.adopt(cycle_plan(*bus)); };
        cycle.connect(bus->link);
    }

    [[nodiscard]] SdoTicket add_job(std::size_t slave, std::uint16_t index, std::uint8_t sub, std::optional<std::vector<std::byte>> value);
    [[nodiscard]] const MappedEntry* find(std::size_t slave, std::uint16_t object, std::uint8_t sub, bool output) const noexcept;
    [[nodiscard]] Result<Signal> resolve(std::size_t slave, std::uint16_t object, std::uint8_t sub, bool output) const;

    Transport& transport;
    BusConfig config;
    std::vector<HotConnectGroup> groups = hot_connect_groups(config);
    ProcessDataCycle cycle;
    std::vector<std::unique_ptr<Bus>> buses;
    Bus* bus = nullptr;
    std::atomic<BusPhase> phase{BusPhase::idle};  ///< of the present bus, for whoever asks from the cycle
    std::optional<Runner> script;
    Error failure;
    std::map<SdoTicket, std::unique_ptr<SdoJob>> jobs;
    SdoTicket next_ticket = 1;
};

Master::Master(Transport& transport, BusConfig config) : impl_(std::make_unique<Impl>(transport, std::move(config))) {}
Master::~Master() {
    // Scripts hold channel entries: they go before the channel.
    impl_->jobs.clear();
    impl_->script.reset();
}

void Master::start() {
    impl_->jobs.clear();
    impl_->script.reset();
    impl_->cycle.withdraw();
    impl_->cycle.set_operational(false);
    if (impl_->bus->phase.load() != BusPhase::idle) impl_->new_bus();
    impl_->failure = {};
    impl_->bus->phase.store(BusPhase::scanning);
    impl_->phase.store(BusPhase::scanning);
    impl_->script.emplace(run_bring_up(*impl_->bus, impl_->failure));
}

void Master::stop() {
    const auto phase_now = impl_->bus->phase.load();
    if (phase_now == BusPhase::stopping || phase_now == BusPhase::stopped) return;
    impl_->jobs.clear();
    impl_->script.reset();
    impl_->bus->phase.store(BusPhase::stopping);
    impl_->phase.store(BusPhase::stopping);
    impl_->script.emplace(run_take_down(*impl_->bus));
}

void Master::step(Instant now) {
    auto& impl = *impl_;
    if (impl.script && !impl.script->done()) impl.script->step(now);
    for (auto& [ticket, job] : impl.jobs)
        if (job->runner && !job->runner->done()) job->runner->step(now);
    const auto phase_now = impl.bus->phase.load();
    impl.phase.store(phase_now);
    impl.cycle.set_operational(phase_now == BusPhase::operational);
    if (phase_now == BusPhase::stopped) impl.cycle.withdraw();
}

Master::Phase Master::phase() const noexcept { return impl_->phase.load(); }
std::string Master::progress() const { return impl_->bus->progress; }
const Error& Master::failure() const { return impl_->failure; }
std::span<const std::string> Master::notes() const noexcept { return impl_->bus->notes; }
Bus& Master::bus() noexcept { return *impl_->bus; }
std::span<const SlaveEmergency> Master::emergencies() const noexcept { return impl_->bus->emergencies.entries(); }

SdoTicket Master::Impl::add_job(std::size_t slave, std::uint16_t index, std::uint8_t sub, std::optional<std::vector<std::byte>> value) {
    const SdoTicket ticket = next_ticket++;
    auto& job = *jobs.emplace(ticket, std::make_unique<SdoJob>()).first->second;
    const auto here = bus->phase.load();
    const bool reachable = here == BusPhase::configuring || here == BusPhase::safeop || here == BusPhase::operational;
    const bool known = slave < bus->slaves.size();
    if (slave >= config.slaves.size()) {
        job.result = Error{"sdo.no_slave", fmt::format("slave {}", slave), "there is no such slave in the configuration", ""};
    } else if (reachable && known && bus->slaves[slave]->away()) {
        job.result =
            Error{"sdo.not_connected", bus->slaves[slave]->subject,
                  fmt::format("{} {} is not possible: its group is not connected", value ? "writing" : "reading", object_text(index, sub)),
                  "plug it in, and wait until it has joined"};
    } else if (!reachable || !known) {
        job.result =
            Error{"sdo.not_ready", fmt::format("slave '{}'", config.slaves[slave].name),
                  fmt::format("{} {} is not possible before the slave is in PREOP", value ? "writing" : "reading", object_text(index, sub)),
                  "wait until the bus is up"};
    } else if (value) {
        job.runner.emplace(run_download(*bus, *bus->slaves[slave], index, sub, std::move(*value), job));
    } else {
        job.runner.emplace(run_upload(*bus, *bus->slaves[slave], index, sub, job));
    }
    return ticket;
}

SdoTicket Master::upload(std::size_t slave, std::uint16_t index, std::uint8_t sub) {
    return impl_->add_job(slave, index, sub, std::nullopt);
}

SdoTicket Master::download(std::size_t slave, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data) {
    return impl_->add_job(slave, index, sub, std::vector<std::byte>(data.begin(), data.end()));
}

std::optional<Result<SdoResult>> Master::poll(SdoTicket ticket) {
    const auto it = impl_->jobs.find(ticket);
    if (it == impl_->jobs.end())
        return Result<SdoResult>{Error{"sdo.no_ticket", "", "the request does not exist, was already answered, or ended with its bus", ""}};
    if (!it->second->result) return std::nullopt;
    Result<SdoResult> result = std::move(*it->second->result);
    impl_->jobs.erase(it);
    return result;
}

std::size_t Master::slave_count() const noexcept { return impl_->config.slaves.size(); }
const SlaveConfig& Master::slave(std::size_t index) const { return impl_->config.slaves.at(index); }
std::span<const HotConnectGroup> Master::groups() const noexcept { return impl_->groups; }

const MappedEntry* Master::Impl::find(std::size_t slave, std::uint16_t object, std::uint8_t sub, bool output) const noexcept {
    if (!cycle.published() || slave >= bus->plan.slaves.size()) return nullptr;
    const auto& entries = output ? bus->plan.slaves[slave].mapped_outputs : bus->plan.slaves[slave].mapped_inputs;
    const auto it = std::find_if(entries.begin(), entries.end(), [&](const MappedEntry& e) { return e.index == object && e.sub == sub; });
    return it == entries.end() ? nullptr : &*it;
}

Result<Signal> Master::Impl::resolve(std::size_t slave, std::uint16_t object, std::uint8_t sub, bool output) const {
    const std::string subject =
        slave < config.slaves.size() ? fmt::format("slave '{}'", config.slaves[slave].name) : fmt::format("slave {}", slave);
    if (const auto* entry = find(slave, object, sub, output))
        return Signal{entry->bit_offset, entry->bits,
                      signed_object(config.slaves[slave].device ? *config.slaves[slave].device : DeviceDescription{}, *entry)};
    if (!cycle.published())
        return Error{"bus.not_planned", subject, "the layout of the process data is not known before the bus is configured", ""};
    return Error{"bus.not_mapped", subject,
                 fmt::format("{} is not in the {} of the slave", object_text(object, sub), output ? "outputs (RxPDO)" : "inputs (TxPDO)"),
                 "map it: choose a PDO that contains it, or add it to the slave's variable PDO"};
}

Result<Signal> Master::input(std::size_t slave, std::uint16_t object, std::uint8_t sub) const {
    return impl_->resolve(slave, object, sub, false);
}
Result<Signal> Master::output(std::size_t slave, std::uint16_t object, std::uint8_t sub) const {
    return impl_->resolve(slave, object, sub, true);
}
std::optional<Master::OutputPlace> Master::output_at(std::size_t bit) const noexcept {
    if (!impl_->cycle.published()) return std::nullopt;
    const auto& slaves = impl_->bus->plan.slaves;
    for (std::size_t s = 0; s < slaves.size(); ++s)
        for (const auto& entry : slaves[s].mapped_outputs)
            if (bit >= entry.bit_offset && bit < std::size_t{entry.bit_offset} + entry.bits) return OutputPlace{s, entry.index, entry.sub};
    return std::nullopt;
}
bool Master::maps_output(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept {
    return impl_->find(slave, object, sub, true) != nullptr;
}
std::span<const FoundOutput> Master::found_outputs(std::size_t slave) const noexcept {
    if (slave >= impl_->bus->slaves.size()) return {};
    return impl_->bus->slaves[slave]->kept;
}
std::optional<std::uint32_t> Master::told(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept {
    if (slave >= impl_->bus->slaves.size()) return std::nullopt;
    const auto& of = *impl_->bus->slaves[slave];
    for (std::size_t i = 0; i < of.answers.size(); ++i)
        if (of.config->asked[i].index == object && of.config->asked[i].sub == sub) return of.answers[i];
    return std::nullopt;
}
bool Master::maps_input(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept {
    return impl_->find(slave, object, sub, false) != nullptr;
}

void Master::pump(Instant now) noexcept { impl_->cycle.pump(now); }
void Master::receive(Instant now) noexcept { impl_->cycle.receive(now); }
void Master::send(Instant now) noexcept { impl_->cycle.send(now); }
std::span<const std::byte> Master::inputs() const noexcept { return impl_->cycle.inputs(); }
std::span<std::byte> Master::outputs() noexcept { return impl_->cycle.outputs(); }
const SlaveHealth& Master::health(std::size_t slave) const noexcept { return impl_->cycle.health(slave); }
GroupPresence Master::group_presence(std::size_t group) const noexcept {
    if (group >= impl_->groups.size()) return GroupPresence::absent;
    bool joining = false, there = true;
    for (const std::size_t slave : impl_->groups[group].slaves) {
        const Attendance now = impl_->cycle.attendance(slave);
        joining = joining || now == Attendance::joining;
        there = there && now == Attendance::there;
    }
    return there ? GroupPresence::present : joining ? GroupPresence::joining : GroupPresence::absent;
}
const BusStatistics& Master::statistics() const noexcept { return impl_->cycle.statistics(); }
Duration Master::period_correction() const noexcept { return impl_->cycle.period_correction(); }
Instant Master::outputs_effective(std::size_t slave, Instant send_time) const noexcept {
    return impl_->cycle.outputs_effective(slave, send_time);
}

void Master::set_tap(void (*tap)(void*, std::span<const std::byte>, Instant, bool) noexcept, void* context) noexcept {
    impl_->cycle.set_tap(tap, context);
}

std::size_t Master::active_faults(std::span<AlarmFact> out) const noexcept {
    const auto facts = impl_->cycle.faults(phase());
    const std::size_t count = std::min(facts.size(), out.size());
    std::copy_n(facts.begin(), count, out.begin());
    return count;
}

namespace {

std::string code_text(std::uint16_t code) { return fmt::format("AL status code {:04X}h {}", code, al_status_info(code).text); }

/// With what is to be done about it.
std::string reason_text(std::uint16_t code) {
    const auto remedy = al_status_info(code).remedy;
    return remedy.empty() ? code_text(code) : fmt::format("{}: {}", code_text(code), remedy);
}

/// Who answers and is out of OP, and the reason of the first who gave one. Who is silent has an alarm of its own.
std::string fallen_text(const Bus& bus) {
    constexpr std::size_t named = 3;
    std::string names, why;
    std::size_t count = 0;
    for (const auto& slave : bus.slaves) {
        if (slave->away()) continue;
        const std::uint32_t al = slave->link.al.load();
        const bool in_op = al == static_cast<std::uint32_t>(AlState::op);
        if (in_op && slave->link.age.load() < bus.config.lost_frames_limit) continue;
        if (slave->link.presence.load() == Presence::silent) continue;
        if (count++ < named) names += (names.empty() ? "" : ", ") + slave->subject;
        if (why.empty() && (al & al_status_error) != 0) why = fmt::format(" ({})", code_text(static_cast<std::uint16_t>(al >> 16)));
    }
    if (count > named) names += fmt::format(" and {} more", count - named);
    return names + why;
}

bool is_back(const Bus& bus, const BusSlave& slave) {
    if (slave.away()) return true;
    return slave.link.al.load() == static_cast<std::uint32_t>(AlState::op) && slave.link.age.load() < bus.config.lost_frames_limit;
}

/// `at` stands behind `first`, or is it.
bool behind(const Bus& bus, std::size_t first, std::size_t at) {
    const auto& places = bus.topology.slaves;
    for (std::optional<std::size_t> up = at; up; up = places[*up].parent) {
        if (*up == first) return true;
        if (*up >= places.size()) break;
    }
    return false;
}

/// What has become of it: an alarm that waits for its acknowledgement must not say that somebody is away who is back. Of the slaves
/// behind `first`, or of all.
std::string outcome(const Bus& bus, const BusSlave* first) {
    std::size_t away = 0, all = 0;
    for (const auto& slave : bus.slaves) {
        if (first != nullptr && !behind(bus, first->found.position, slave->found.position)) continue;
        ++all;
        away += is_back(bus, *slave) ? 0 : 1;
    }
    if (away == 0) return all == 1 ? "it is back in OP" : "all slaves are back in OP";
    return away == all ? "" : fmt::format("slaves still away: {}", away);
}

/// Who was sent out of OP, and by whom.
std::string foreign_text(const Bus& bus) {
    std::string slaves = fallen_text(bus);
    if (bus.link.foreign_frames.load() == 0) return slaves;
    return (slaves.empty() ? "" : slaves + "; ") + "of whom frames were heard: " + sender_text(bus.link);
}

std::string reference_clock(const Bus& bus) {
    return bus.reference ? "the reference clock is that of " + bus.slaves[*bus.reference]->subject : std::string{};
}

/// Whose clock it is: where several are off from the reference and none is not, it is the reference's own.
std::string furthest_clock(const Bus& bus) {
    const BusSlave* furthest = nullptr;
    std::size_t off = 0, others = 0;
    for (const auto& slave : bus.slaves) {
        if (!slave->dc || slave->away() || bus.reference == slave->index) continue;
        ++others;
        off += slave->dc_difference > clock_is_off_ns ? 1 : 0;
        if (slave->dc_difference > (furthest != nullptr ? furthest->dc_difference : 0)) furthest = slave.get();
    }
    if (furthest == nullptr || !bus.reference) return {};
    const auto& reference = bus.slaves[*bus.reference]->subject;
    if (others > 1 && off == others) return fmt::format("{}, the reference: the clocks of all others differ from its own", reference);
    return fmt::format("most of all {} from {}, the reference", furthest->subject, reference);
}

std::string ring_text(const Bus& bus) {
    const RingState ring = bus.link.ring.load();
    return ring.needs_mending() ? break_text(bus, ring) : "it is closed again";
}

/// The cable by which slaves are reached that are away. In a ring that is broken there are two, and either of them may be the one.
std::string way_in(const Bus& bus, const BusSlave& first) {
    const RingState ring = bus.link.ring.load();
    const bool between = ring.shape == RingShape::open && std::size_t{ring.before_break} + ring.behind_break < bus.topology.slaves.size();
    return between ? break_text(bus, ring) : connection_text(bus, first);
}

std::string with_outcome(std::string text, const std::string& outcome) { return outcome.empty() ? text : text + "; " + outcome; }

/// How many slaves fell by it, and what has become of them.
std::string victims(const Bus& bus, const AlarmFact& fact) {
    if (fact.b <= 0) return {};
    return with_outcome(fmt::format("{:.0f} slave{} fell by it", fact.b, fact.b == 1 ? "" : "s"), outcome(bus, nullptr));
}

/// The sync unit that this slave shares: its name, and who is in it.
std::string unit_text(const Bus& bus, const BusSlave& first) {
    if (first.index >= bus.plan.slaves.size() || !bus.plan.slaves[first.index].unit) return {};
    std::string names;
    for (const std::size_t slave : bus.plan.units[*bus.plan.slaves[first.index].unit].slaves)
        names += (names.empty() ? "" : ", ") + bus.slaves[slave]->subject;
    return fmt::format("sync unit '{}': {}", first.config->sync_unit, names);
}

}  // namespace

std::string Master::detail(const AlarmFact& fact) const {
    const auto& slaves = impl_->bus->slaves;
    const auto& link = impl_->bus->link;
    switch (BusAlarm{fact.id}) {
        case BusAlarm::foreign_master: return sender_text(link);
        case BusAlarm::foreign_command:
        case BusAlarm::foreign_command_tolerated: return foreign_text(*impl_->bus);
        case BusAlarm::starved_slave_left_op:
        case BusAlarm::starved_slave_dropped_out: return fallen_text(*impl_->bus);
        case BusAlarm::link_down:
            if (const auto trouble = impl_->transport.link_trouble())
                return with_outcome(fmt::format("{}: {}; {}", trouble->subject, trouble->what, trouble->remedy),
                                    victims(*impl_->bus, fact));
            return victims(*impl_->bus, fact);
        case BusAlarm::frames_lost: return victims(*impl_->bus, fact);
        case BusAlarm::dc_not_locked:
        case BusAlarm::reference_clock_lost: return reference_clock(*impl_->bus);
        case BusAlarm::dc_out_of_sync: return furthest_clock(*impl_->bus);
        case BusAlarm::ring_broken: return ring_text(*impl_->bus);
        case BusAlarm::stranger_plugged_in: return impl_->bus->strangers;
        case BusAlarm::sync_unit_not_exchanged:
        case BusAlarm::sync_unit_dropped_out: return fact.index < slaves.size() ? unit_text(*impl_->bus, *slaves[fact.index]) : "";
        default: break;
    }
    if (fact.source != AlarmSource::slave || fact.index >= slaves.size()) return {};
    const auto& slave = *slaves[fact.index];
    switch (BusAlarm{fact.id}) {
        case BusAlarm::slave_left_op:
        case BusAlarm::slave_dropped_out:
            if (fact.a != 0)
                return fmt::format(
                    "{}; it is {}", fact.b == 0 ? "it gives no error of its own" : reason_text(static_cast<std::uint16_t>(fact.b)),
                    is_back(*impl_->bus, slave) ? std::string{"back in OP"}
                                                : fmt::format("in {}", name(static_cast<AlState>(static_cast<std::uint8_t>(fact.a)))));
            if (fact.id == id(BusAlarm::slave_left_op))
                return is_back(*impl_->bus, slave) ? "it is back in OP" : "its reason is being read";
            return with_outcome(connection_text(*impl_->bus, slave), is_back(*impl_->bus, slave) ? "it is back in OP" : "");
        case BusAlarm::working_counter_wrong:
            return with_outcome(slave.not_exchanged, is_back(*impl_->bus, slave) ? "it is back in OP" : "");
        case BusAlarm::slave_lost:
            return with_outcome(connection_text(*impl_->bus, slave), is_back(*impl_->bus, slave) ? "it is back in OP" : "");
        case BusAlarm::cable_errors:
        case BusAlarm::cable_loses_link: return cable_text(*impl_->bus, slave, static_cast<unsigned>(fact.b));
        case BusAlarm::cable_broken:
        case BusAlarm::branch_dropped_out: return with_outcome(way_in(*impl_->bus, slave), outcome(*impl_->bus, &slave));
        case BusAlarm::other_device:
        case BusAlarm::other_device_tolerated:
        case BusAlarm::group_does_not_join:
        case BusAlarm::slave_does_not_return: return slave.last_trouble;
        default: return {};
    }
}

std::span<const AlarmInfo> Master::alarms() noexcept { return bus_alarms; }

}  // namespace taktwerk::ecat
