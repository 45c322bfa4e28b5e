#include "hmi_bridge/gateway/drive_requests.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/port/parameter_text.hpp"
#include "hmi_bridge/words/answer_text.hpp"
#include "hmi_bridge/words/target_names.hpp"

namespace taktwerk::hmi {

namespace {

using axes::ParameterStorage;
using runtime::Answer;

constexpr axes::ParameterAddress store_object{0x1010, 1};                                                     // CiA 301
const std::vector<std::byte> signature_save{std::byte{'s'}, std::byte{'a'}, std::byte{'v'}, std::byte{'e'}};  // CiA 301 1010h

bool powered(const axes::AxisView& view) noexcept {
    using axes::PowerState;
    return view.drive_state == PowerState::enabled || view.drive_state == PowerState::quick_stop ||
           view.drive_state == PowerState::fault_reaction;
}

bool moving(const axes::AxisView& view) {
    using axes::AxisState;
    switch (view.state) {
        case AxisState::Disabled:
        case AxisState::Standstill:
        case AxisState::ErrorStop: return view.set_velocity != 0;
        default: return true;
    }
}

/// Bytes of a text object: what can be shown of them.
std::string text_of(const std::vector<std::byte>& bytes) {
    std::string out;
    for (const auto b : bytes)
        if (const auto c = std::to_integer<unsigned char>(b); c >= 0x20) out += static_cast<char>(c);
    return out;
}

Error motor_on(std::string subject, std::string what) {
    return {"command.not_possible_now", std::move(subject), std::move(what), "Switch the axis off first: `taktwerk disable AXIS --wait`."};
}

}  // namespace

DriveRequests::DriveRequests(MachineLink& machine, std::function<void(std::string_view)> log, const Hands* hands)
    : machine_(machine), log_(std::move(log)), hands_(hands) {
    if (!log_) log_ = [](std::string_view) {};
}

Result<DriveRequests::Place> DriveRequests::find(const DriveRequest& request, const runtime::Snapshot* snapshot) {
    const auto axis = find_target(machine_.layout(), TargetKind::axis, request.axis);
    if (!axis) return axis.error();
    Place place{*axis, machine_.drive(*axis), snapshot};
    const auto subject = "axis " + request.axis;
    if (!place.drive.port || !place.drive.profile)
        return Error{"drive.none", subject, "has no drive: it is virtual, or simulated: true", "Ask for an axis that has one."};
    if (!snapshot || *axis >= snapshot->axes.size())
        return Error{"state.not_yet", subject, "the machine has not executed a cycle yet", "Ask again in a moment."};
    return place;
}

void DriveRequests::handle(DriveRequest request, const runtime::Snapshot* snapshot, Instant now) {
    Job job;
    job.answer.tag = request.tag;
    job.answer.id = request.id;
    if (auto refused = start(request, snapshot, job)) {
        job.answer.error = std::move(refused);
        answers_.push_back(std::move(job.answer));
        return;
    }
    job.until = now + (request.kind == DriveRequestKind::store ? store_patience : patience);
    jobs_.push_back(std::move(job));
}

std::optional<Error> DriveRequests::start(const DriveRequest& request, const runtime::Snapshot* snapshot, Job& job) {
    if (jobs_.size() >= at_work)
        return Error{"command.queue_full", "axis " + request.axis, fmt::format("{} requests to drives are under way", at_work),
                     "Wait for an answer, then give it again."};
    const auto place = find(request, snapshot);
    if (!place) return place.error();
    job.port = place->drive.port;
    switch (request.kind) {
        case DriveRequestKind::read: return start_read(request, *place, job);
        case DriveRequestKind::write: return start_write(request, *place, job);
        case DriveRequestKind::store: return start_store(request, *place, job);
        case DriveRequestKind::clear_turns: return start_clear_turns(request, *place, job);
    }
    return std::nullopt;
}

std::optional<Error> DriveRequests::start_read(const DriveRequest& request, const Place& place, Job& job) {
    const auto found = axes::find_parameter(*place.drive.profile, request.parameter);
    if (!found) return found.error();
    job.parameter = *found;
    job.answer.parameter = axes::name_of(**found);
    if ((*found)->reach == axes::ParameterReach::bus) job.ticket = job.port->read_parameter((*found)->address);
    if (job.ticket != 0) return std::nullopt;
    return Error{"drive.no_address", job.answer.parameter, fmt::format("{} cannot be read through the machine", (*found)->name),
                 "Look at the drive's panel, or use its maker's tool."};
}

std::optional<Error> DriveRequests::check_authority(const DriveRequest& request, const Place& place) const {
    const auto& layout = machine_.layout();
    const auto& view = place.snapshot->axes[place.axis];
    runtime::CommandAnswer refusal;
    refusal.owner = view.owner;
    if (view.owner == axes::Owner::program) refusal.answer = Answer::no_control;
    else if (place.snapshot->mode == runtime::Mode::automatic) refusal.answer = Answer::wrong_mode;
    else return check_hands(request, place);
    return explain(refusal, CommandKind::none, "axis " + layout.axes[place.axis].name, layout.block_at(refusal.holder));
}

std::optional<Error> DriveRequests::check_hands(const DriveRequest& request, const Place& place) const {
    const auto& axes = machine_.layout().axes;
    for (std::uint16_t i = 0; i < axes.size() && i < place.snapshot->axes.size(); ++i) {
        if (axes[i].drive != axes[place.axis].drive) continue;
        const auto& view = place.snapshot->axes[i];
        const auto* hand = hands_ ? hands_->on(i) : nullptr;
        if (hand && hand->client == request.client) continue;
        const auto refuse = [&](std::string what, std::string remedy) {
            return Error{"command.no_control", "axis " + axes[i].name, std::move(what), std::move(remedy)};
        };
        if (moving(view))
            return refuse(fmt::format("it moves, and {} moves it", hand ? hand->name : "a client that is gone"),
                          "Stop the axis, or wait until it stands.");
        if (hand && (powered(view) || view.owner == axes::Owner::commissioning))
            return refuse(fmt::format("{} commands it", hand->name),
                          "Let that client let go of it: it switches the axis off, releases the control, or ends.");
    }
    return std::nullopt;
}

bool DriveRequests::any_axis_powered(const Place& place) const {
    const auto& axes = machine_.layout().axes;
    for (std::size_t i = 0; i < axes.size() && i < place.snapshot->axes.size(); ++i)
        if (axes[i].drive == axes[place.axis].drive && powered(place.snapshot->axes[i])) return true;
    return false;
}

std::optional<Error> DriveRequests::start_write(const DriveRequest& request, const Place& place, Job& job) {
    const auto& profile = *place.drive.profile;
    const auto found = axes::find_parameter(profile, request.parameter);
    if (!found) return found.error();
    const auto& parameter = **found;
    const auto name = axes::name_of(parameter);
    const auto raw = axes::parse_value(profile, parameter, request.value);
    if (!raw) return raw.error();
    if (auto refused = check_authority(request, place)) return refused;
    if (parameter.action)
        return Error{"drive.action", name, fmt::format("writing {} does something instead of setting it", parameter.name),
                     "End the machine, then use `taktwerk drive set` on its bus."};
    if (parameter.change == axes::ParameterChange::disabled && powered(place.snapshot->axes[place.axis]))
        return motor_on(name, fmt::format("{} may be written only while the motor is off [manual {}]", parameter.name, parameter.section));
    const bool each = profile.storage.way == ParameterStorage::each_write;
    const bool switches_on = each && parameter.address == profile.storage.switched_by && *raw != 0;
    const bool always = each && profile.storage.switched_by.index == 0;
    if ((switches_on || always) && !request.store)
        return Error{"drive.would_store", name, "this write would go into the drive's EEPROM", "Say that it may: `store`, or --store."};
    job.ticket = job.port->write_parameter(parameter.address, axes::to_bytes(parameter, *raw));
    if (job.ticket == 0)
        return Error{"drive.not_now", name, "the machine writes it each cycle, or it must not change while the motor is on",
                     "Change what the machine file says of it, or switch the axis off first."};
    job.answer.parameter = name;
    log_(fmt::format("{} writes {} ({}) of axis {}, {}: {}{}", request.who, name, parameter.name, request.axis, profile.name,
                     axes::value_text(parameter, *raw), each && request.store ? ", into the EEPROM" : ""));
    return std::nullopt;
}

std::optional<Error> DriveRequests::start_store(const DriveRequest& request, const Place& place, Job& job) {
    const auto& profile = *place.drive.profile;
    const auto subject = "axis " + request.axis;
    if (profile.storage.way != ParameterStorage::on_request)
        return Error{"drive.cannot_store", subject, fmt::format("{} does not store its parameters on request", profile.name),
                     "See its page under docs/drives/."};
    if (auto refused = check_authority(request, place)) return refused;
    // An EEPROM takes its time, and a drive that stores may not answer (XP200 9.6.6: 5 s).
    if (any_axis_powered(place)) return motor_on(subject, "a drive stores only while its motors are off");
    const bool service = job.port->capabilities().has(axes::DriveService::save_parameters);
    job.ticket =
        service ? job.port->start_service(axes::DriveService::save_parameters) : job.port->write_parameter(store_object, signature_save);
    if (job.ticket == 0)
        return Error{"drive.not_now", subject, "the drive must not store in this state: what is forced on or moving would be stored too",
                     "See its page under docs/drives/."};
    log_(fmt::format("{} stores all parameters of axis {}, {}, in the EEPROM", request.who, request.axis, profile.name));
    return std::nullopt;
}

std::optional<Error> DriveRequests::start_clear_turns(const DriveRequest& request, const Place& place, Job& job) {
    const auto& profile = *place.drive.profile;
    const auto subject = "axis " + request.axis;
    if (!job.port->capabilities().has(axes::DriveService::clear_multi_turn))
        return Error{"drive.no_turns", subject, fmt::format("{} has no command that makes its encoder forget its turns", profile.name),
                     "See its page under docs/drives/."};
    if (auto refused = check_authority(request, place)) return refused;
    if (powered(place.snapshot->axes[place.axis])) return motor_on(subject, "the turns are cleared only while the motor is off");
    job.ticket = job.port->start_service(axes::DriveService::clear_multi_turn);
    if (job.ticket == 0)
        return Error{"drive.not_now", subject, "the drive is not in a state in which its turns may be cleared",
                     "Wait until the motor has no power and an earlier request is over, then give it again."};
    log_(fmt::format("{} clears the encoder's turns of axis {}, {}: the axis has no reference any more", request.who, request.axis,
                     profile.name));
    return std::nullopt;
}

void DriveRequests::forget(std::uint64_t tag) noexcept {
    for (auto& job : jobs_) job.wanted = job.wanted && job.answer.tag != tag;
    std::erase_if(answers_, [&](const DriveAnswer& answer) { return answer.tag == tag; });
}

void DriveRequests::step(Instant now) {
    for (auto& job : jobs_) {
        auto answered = job.port->service_answer(job.ticket);
        if (!answered && now < job.until) continue;
        if (!answered) {
            job.answer.error = Error{"drive.silent", job.answer.parameter, "the drive gave no answer",
                                     "See `taktwerk monitor`: is its slave in OP, is its line connected?"};
        } else if (!answered->ok()) {
            job.answer.error = answered->error();
        } else if (job.parameter) {
            job.answer.bytes = std::move(answered->value());
            if (job.parameter->bits == 0) job.answer.shown = text_of(job.answer.bytes);
            else if (const auto raw = axes::from_bytes(*job.parameter, job.answer.bytes))
                job.answer.shown = axes::value_text(*job.parameter, *raw);
            else job.answer.error = raw.error();
        }
        if (job.wanted) answers_.push_back(std::move(job.answer));
        job.ticket = 0;
    }
    std::erase_if(jobs_, [](const Job& job) { return job.ticket == 0; });
}

std::optional<DriveAnswer> DriveRequests::next_answer() {
    if (answers_.empty()) return std::nullopt;
    auto answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
}

}  // namespace taktwerk::hmi
