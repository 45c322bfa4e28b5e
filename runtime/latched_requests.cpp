#include "runtime/latched_requests.hpp"

namespace taktwerk::runtime {

using namespace axes;

bool LatchedRequests::push(const Request& request) noexcept {
    if (count_ == capacity) return false;
    requests_[count_++] = request;
    return true;
}

CommandId LatchedRequests::real_id(CommandId mine) const noexcept {
    if (!(mine & provisional)) return mine;
    for (const auto& known : known_)
        if (known.mine == mine) return known.real;
    return 0;
}

Submitted LatchedRequests::submit(AxisRef axis, const AxisCommand& command, Owner owner) noexcept {
    if (axis.index >= views_.size()) return {0, ErrorId::invalid_axis};
    next_ = (next_ + 1) & ~provisional;
    Request request;
    request.axis = axis;
    request.command = command;
    request.id = next_ | provisional;
    request.owner = owner;
    if (!push(request)) return {0, ErrorId::queue_full};
    auto& view = views_[axis.index];
    if (view.queued_count < view.queued.size()) view.queued[view.queued_count++] = request.id;
    return {request.id, ErrorId::none};
}

ErrorId LatchedRequests::power(AxisRef axis, bool enable, bool positive, bool negative, Owner owner) noexcept {
    if (axis.index >= power_.size()) return ErrorId::invalid_axis;
    auto& wish = power_[axis.index];
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

ErrorId LatchedRequests::set_position(AxisRef axis, double position, bool relative, Owner owner) noexcept {
    if (axis.index >= views_.size()) return ErrorId::invalid_axis;
    Request request;
    request.kind = Kind::set_position;
    request.axis = axis;
    request.owner = owner;
    request.value = position;
    request.relative = relative;
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
                const auto answer = axes.submit(r.axis, r.command, r.owner);
                known_[known_next_] = {r.id, answer.id, r.axis.index, answer.error, false};
                known_next_ = (known_next_ + 1) % capacity;
                break;
            }
            case Kind::reset: axes.reset(r.axis, r.owner); break;
            case Kind::set_position: axes.set_position(r.axis, r.value, r.relative, r.owner); break;
            case Kind::release_stop: axes.release_stop(r.axis, real_id(r.id), r.owner); break;
            case Kind::renew_jog: axes.renew_jog(r.axis, real_id(r.id), r.value, r.owner); break;
        }
    }
    count_ = 0;
}

void LatchedRequests::renew(AxisRequests& axes) const noexcept {
    for (std::size_t i = 0; i < power_.size(); ++i) {
        auto& wish = power_[i];
        if (!wish.held) continue;
        wish.answer = axes.power(AxisRef{static_cast<std::uint16_t>(i)}, wish.enable, wish.positive, wish.negative, wish.owner);
        if (!wish.enable) wish.held = false;  // taken back once
    }
}

void LatchedRequests::latch(std::span<const AxisView> real, std::span<AxisView> task_views) noexcept {
    for (std::size_t i = 0; i < real.size(); ++i) {
        task_views[i] = real[i];
        task_views[i].last_id = next_ | provisional;  // all of the task's ids are known to the axes by now
    }
    for (auto& known : known_) {
        if (known.mine == 0 || known.axis >= task_views.size() || known.told) continue;
        auto& view = task_views[known.axis];
        if (known.refused != ErrorId::none) {
            known.told = true;
            view.ledger[view.ledger_next] = {known.mine, Outcome::error, known.refused};
            view.ledger_next = static_cast<std::uint8_t>((view.ledger_next + 1) % view.ledger.size());
            continue;
        }
        if (view.active == known.real) view.active = known.mine;
        for (std::size_t q = 0; q < view.queued_count; ++q)
            if (view.queued[q] == known.real) view.queued[q] = known.mine;
        for (auto& entry : view.ledger)
            if (entry.id == known.real) entry.id = known.mine;
    }
}

void LatchedRequests::clear() noexcept {
    count_ = 0;
    known_ = {};
    for (auto& wish : power_) wish = {};
}

}  // namespace taktwerk::runtime
