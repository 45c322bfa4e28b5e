#include "runtime/tasks/latched_requests.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/parameters.hpp"

namespace taktwerk::runtime {

using axes::AxisCommand;
using axes::AxisRef;
using axes::AxisRequests;
using axes::AxisState;
using axes::AxisView;
using axes::CommandId;
using axes::CommandKind;
using axes::CommandStatus;
using axes::ErrorId;
using axes::Outcome;
using axes::Owner;
using axes::Submitted;

bool LatchedRequests::push(const Request& request) noexcept {
    if (count_ == capacity) return false;
    requests_[count_++] = request;
    return true;
}

CommandId LatchedRequests::real_id(CommandId mine) const noexcept {
    if (!(mine & provisional)) return mine;
    for (std::size_t i = 0; i < known_count_; ++i)
        if (known_[i].mine == mine) return known_[i].real;
    return 0;
}

void LatchedRequests::remember(const Request& request, Submitted answer) noexcept {
    if (known_count_ == known_.size()) {
        std::move(known_.begin() + 1, known_.end(), known_.begin());
        --known_count_;
    }
    const auto fate = answer.error != ErrorId::none ? Known::Fate::refused : answer.id != 0 ? Known::Fate::accepted : Known::Fate::done;
    known_[known_count_++] = {request.id, answer.id, request.axis.index, fate, false, answer.error};
}

Submitted LatchedRequests::push_with_id(Request& request) noexcept {
    next_ = (next_ + 1) & ~provisional;
    request.id = next_ | provisional;
    if (!push(request)) return {0, ErrorId::queue_full};
    auto& view = views_[request.axis.index];
    if (view.queued_count < view.queued.size()) view.queued[view.queued_count++] = request.id;
    return {request.id, ErrorId::none};
}

Submitted LatchedRequests::submit(AxisRef axis, const AxisCommand& command, Owner owner) noexcept {
    if (axis.index >= views_.size()) return {0, ErrorId::invalid_axis};
    Request request;
    request.axis = axis;
    request.command = command;
    request.owner = owner;
    return push_with_id(request);
}

ErrorId LatchedRequests::power(AxisRef axis, bool enable, bool positive, bool negative, Owner owner) noexcept {
    if (axis.index >= wishes_.size()) return ErrorId::invalid_axis;
    auto& wish = wishes_[axis.index];
    const auto answer = wish.answer;
    wish = {true, enable, positive, negative, owner, answer};
    return answer;
}

ErrorId LatchedRequests::reset(AxisRef axis, Owner owner) noexcept {
    if (axis.index >= views_.size()) return ErrorId::invalid_axis;
    Request request;
    request.kind = Kind::reset;
    request.axis = axis;
    request.owner = owner;
    return push(request) ? ErrorId::none : ErrorId::queue_full;
}

Submitted LatchedRequests::set(AxisRef axis, const axes::AxisSetting& setting, Owner owner) noexcept {
    if (axis.index >= views_.size()) return {0, ErrorId::invalid_axis};
    // What the axis itself would say (Axis::set), as far as the latched view knows.
    const auto& view = views_[axis.index];
    if (view.owner != owner && view.owner != Owner::none) return {0, ErrorId::owned_by_other};
    if (const auto* position = std::get_if<axes::SetPosition>(&setting)) {
        if (!std::isfinite(position->position)) return {0, ErrorId::invalid_position};
        if (!view.online) return {0, ErrorId::drive_not_ready};
        if (view.state == AxisState::Homing) return {0, ErrorId::state_forbids};
    }
    if (const auto* parameter = std::get_if<axes::WriteParameter>(&setting))
        if (const auto error = axes::check_write(view, *parameter); error != ErrorId::none) return {0, error};
    Request request;
    request.kind = Kind::set;
    request.axis = axis;
    request.owner = owner;
    request.setting = setting;
    return push_with_id(request);
}

ErrorId LatchedRequests::update(AxisRef axis, CommandId id, const AxisCommand& command, Owner owner) noexcept {
    if (axis.index >= views_.size()) return ErrorId::invalid_axis;
    Request request;
    request.kind = Kind::update;
    request.axis = axis;
    request.id = id;
    request.command = command;
    request.owner = owner;
    return push(request) ? ErrorId::none : ErrorId::queue_full;
}

void LatchedRequests::release_stop(AxisRef axis, CommandId id, Owner owner) noexcept {
    Request request;
    request.kind = Kind::release_stop;
    request.axis = axis;
    request.id = id;
    request.owner = owner;
    push(request);
}

ErrorId LatchedRequests::renew_jog(AxisRef axis, CommandId id, double velocity, Owner owner) noexcept {
    if (axis.index >= views_.size()) return ErrorId::invalid_axis;
    Request request;
    request.kind = Kind::renew_jog;
    request.axis = axis;
    request.id = id;
    request.value = velocity;
    request.owner = owner;
    return push(request) ? ErrorId::none : ErrorId::queue_full;
}

void LatchedRequests::apply(AxisRequests& axes) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const auto& r = requests_[i];
        switch (r.kind) {
            case Kind::submit: {
                auto command = r.command;
                if (auto* probe = std::get_if<axes::ProbeDetails>(&command.details)) probe->replaces = real_id(probe->replaces);
                remember(r, axes.submit(r.axis, command, r.owner));
                break;
            }
            case Kind::reset:
                if (const auto error = axes.reset(r.axis, r.owner); error != ErrorId::none)
                    resets_[r.axis.index] = {RefusedReset::Show::resetting, error};
                else resets_[r.axis.index] = {};
                break;
            case Kind::set: remember(r, axes.set(r.axis, r.setting, r.owner)); break;
            case Kind::update: axes.update(r.axis, real_id(r.id), r.command, r.owner); break;
            case Kind::release_stop: axes.release_stop(r.axis, real_id(r.id), r.owner); break;
            case Kind::renew_jog: axes.renew_jog(r.axis, real_id(r.id), r.value, r.owner); break;
        }
    }
    count_ = 0;
    for (std::size_t i = 0; i < wishes_.size(); ++i) {
        if (!wishes_[i].given) continue;
        const auto answer = held_[i].answer;
        held_[i] = wishes_[i];
        held_[i].answer = answer;
        wishes_[i].given = false;
    }
}

void LatchedRequests::renew(AxisRequests& axes) noexcept {
    for (std::size_t i = 0; i < held_.size(); ++i) {
        auto& wish = held_[i];
        if (!wish.given) continue;
        wish.answer = axes.power(AxisRef{static_cast<std::uint16_t>(i)}, wish.enable, wish.positive, wish.negative, wish.owner);
        if (!wish.enable) wish.given = false;  // taken back once
    }
}

bool LatchedRequests::translate(const Known& known, const AxisView& real, AxisView& view) noexcept {
    if (real.status(known.real) == CommandStatus::unknown) return false;
    if (view.active == known.real) view.active = known.mine;
    for (std::size_t q = 0; q < view.queued_count; ++q)
        if (view.queued[q] == known.real) view.queued[q] = known.mine;
    for (auto& beside : view.side)
        if (beside == known.real) beside = known.mine;
    for (auto& latched : view.probe_latched)
        if (latched == known.real) latched = known.mine;
    if (view.lock == known.real) view.lock = known.mine;
    for (auto& entry : view.ledger)
        if (entry.id == known.real) entry.id = known.mine;
    return true;
}

bool LatchedRequests::tell(Known& known, std::uint8_t& told, AxisView& view) noexcept {
    if (known.told) return false;
    if (told == most_told) {  // to its block it is still on its way
        if (static_cast<std::int32_t>(view.last_id - known.mine) >= 0) view.last_id = known.mine - 1;
        return true;
    }
    ++told;
    known.told = true;
    view.ledger[view.ledger_next] = {known.mine, known.fate == Known::Fate::done ? Outcome::done : Outcome::error, known.error};
    view.ledger_next = static_cast<std::uint8_t>((view.ledger_next + 1) % view.ledger.size());
    return true;
}

template <class Keep>
void LatchedRequests::keep_if(Keep keep) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < known_count_; ++i)
        if (auto known = known_[i]; keep(known)) known_[kept++] = known;
    known_count_ = kept;
}

void LatchedRequests::latch(std::span<const AxisView> real, std::span<AxisView> task_views) noexcept {
    for (std::size_t i = 0; i < real.size(); ++i) {
        auto& view = task_views[i];
        view = real[i];
        view.last_id = next_ | provisional;  // all of the task's ids are known to the axes by now
        auto& reset = resets_[i];
        if (reset.show == RefusedReset::Show::resetting) {
            view.resetting = true;
            reset.show = RefusedReset::Show::error;
        } else if (reset.show == RefusedReset::Show::error) {
            view.resetting = false;
            view.reset_error = reset.error;
            reset.show = RefusedReset::Show::nothing;
        }
        wishes_[i].answer = held_[i].answer;
    }
    // Real outcomes first: an answer takes the place of the oldest entry of the ledger.
    using Fate = Known::Fate;
    keep_if([&](Known& k) { return k.fate != Fate::accepted || translate(k, real[k.axis], task_views[k.axis]); });
    std::fill(told_.begin(), told_.end(), std::uint8_t{0});
    keep_if([&](Known& k) { return k.fate == Fate::accepted || tell(k, told_[k.axis], task_views[k.axis]); });
}

void LatchedRequests::clear() noexcept {
    count_ = known_count_ = 0;
    for (auto* all : {&wishes_, &held_})
        for (auto& wish : *all) wish = {};
    for (auto& reset : resets_) reset = {};
}

}  // namespace taktwerk::runtime
