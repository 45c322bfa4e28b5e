#pragma once
// The commands of one axis: the active one, those waiting behind it, and what became of the finished ones. Plain bookkeeping:
// it decides nothing. Real-time safe.

#include <array>
#include <cstdint>

#include "axes/axis/axis_view.hpp"
#include "axes/axis/command.hpp"

namespace taktwerk::axes {

struct AcceptedCommand {
    CommandId id = 0;
    Owner owner = Owner::none;
    AxisCommand command;
};

class CommandQueue {
public:
    static constexpr std::size_t capacity = 8;

    [[nodiscard]] CommandId next_id() noexcept {
        changed_ = true;
        if (++last_id_ == 0) ++last_id_;
        return last_id_;
    }
    [[nodiscard]] bool has_active() const noexcept { return active_.id != 0; }
    [[nodiscard]] const AcceptedCommand& active() const noexcept { return active_; }
    [[nodiscard]] AcceptedCommand& active() noexcept { return active_; }
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_; }

    void activate(const AcceptedCommand& command) noexcept {
        changed_ = true;
        active_ = command;
        in_target_ = false;
    }
    /// Only when there is room (waiting() < depth of the axis).
    void push(const AcceptedCommand& command) noexcept {
        changed_ = true;
        queue_[waiting_++] = command;
    }
    /// The next in turn; only when waiting() > 0.
    [[nodiscard]] const AcceptedCommand& front() const noexcept { return queue_[0]; }
    /// Only when waiting() > 0.
    [[nodiscard]] AcceptedCommand pop() noexcept {
        changed_ = true;
        const auto first = queue_[0];
        for (std::size_t i = 1; i < waiting_; ++i) queue_[i - 1] = queue_[i];
        --waiting_;
        return first;
    }

    /// In order; i < waiting().
    [[nodiscard]] AcceptedCommand& waiting_at(std::size_t i) noexcept { return queue_[i]; }
    [[nodiscard]] const AcceptedCommand& waiting_at(std::size_t i) const noexcept { return queue_[i]; }

    // Beside the active one: a place per slot.
    [[nodiscard]] CommandId beside(SideSlot slot) const noexcept { return side_[static_cast<std::size_t>(slot)]; }
    void occupy(SideSlot slot, CommandId id) noexcept {
        changed_ = true;
        side_[static_cast<std::size_t>(slot)] = id;
    }
    void finish_beside(SideSlot slot, Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        auto& id = side_[static_cast<std::size_t>(slot)];
        if (id != 0) record(id, outcome, error);
        id = 0;
    }

    void set_in_target(bool reached) noexcept { in_target_ = reached; }

    void finish_active(Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        if (active_.id == 0) return;
        changed_ = true;
        record(active_.id, outcome, error);
        active_ = {};
        in_target_ = false;
    }
    void finish_waiting(Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        for (std::size_t i = 0; i < waiting_; ++i) record(queue_[i].id, outcome, error);
        changed_ = changed_ || waiting_ > 0;
        waiting_ = 0;
    }
    void record(CommandId id, Outcome outcome, ErrorId error) noexcept {
        changed_ = true;
        ledger_[ledger_next_] = {id, outcome, error};
        ledger_next_ = static_cast<std::uint8_t>((ledger_next_ + 1) % ledger_.size());
    }

    /// Writes what has changed since the last call.
    void publish(AxisView& view) noexcept {
        view.active_in_target = in_target_;
        if (changed_) publish_changes(view);
    }

private:
    void publish_changes(AxisView& view) noexcept {
        changed_ = false;
        view.active = active_.id;
        view.active_kind = active_.command.kind;
        if (active_.id != 0 || view.lock == 0) view.holder = active_.command.instance;
        view.queued_count = static_cast<std::uint8_t>(waiting_);
        for (std::size_t i = 0; i < capacity; ++i) view.queued[i] = i < waiting_ ? queue_[i].id : 0;
        constexpr auto superimposed = static_cast<std::size_t>(SideSlot::superimposed);
        view.side[superimposed] = side_[superimposed];
        view.ledger = ledger_;
        view.ledger_next = ledger_next_;
        view.last_id = last_id_;
    }

    AcceptedCommand active_;
    bool in_target_ = false;
    std::array<AcceptedCommand, capacity> queue_{};
    std::size_t waiting_ = 0;
    std::array<CommandId, side_slot_count> side_{};
    decltype(AxisView::ledger) ledger_{};
    std::uint8_t ledger_next_ = 0;
    CommandId last_id_ = 0;
    bool changed_ = true;  // since the last publish()
};

}  // namespace taktwerk::axes
