#pragma once
// The commands of one group: the active one, those behind it, and what became of the finished ones. Plain bookkeeping: it decides nothing.
// Real-time safe.

#include <array>
#include <cstdint>

#include "axes/group/group_equipment.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

struct AcceptedGroupCommand {
    CommandId id = 0;
    Owner owner = Owner::none;
    GroupCommand command;
    CommandPlace place{};
};

class GroupQueue {
public:
    static constexpr std::size_t capacity = GroupView::most_waiting;

    [[nodiscard]] CommandId next_id() noexcept {
        if (++last_id_ == 0) ++last_id_;
        return last_id_;
    }
    [[nodiscard]] bool has_active() const noexcept { return active_.id != 0; }
    [[nodiscard]] const AcceptedGroupCommand& active() const noexcept { return active_; }
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_; }
    /// In their turn; i < waiting().
    [[nodiscard]] const AcceptedGroupCommand& waiting_at(std::size_t i) const noexcept { return ring_[(first_ + i) % capacity]; }
    [[nodiscard]] bool full() const noexcept { return waiting_ == capacity; }

    void activate(const AcceptedGroupCommand& command) noexcept { active_ = command; }
    /// Only unless full().
    void push(const AcceptedGroupCommand& command) noexcept {
        ring_[(first_ + waiting_) % capacity] = command;
        ++waiting_;
    }
    /// Likewise, in front of all that wait.
    void push_front(const AcceptedGroupCommand& command) noexcept {
        first_ = (first_ + capacity - 1) % capacity;
        ring_[first_] = command;
        ++waiting_;
    }
    /// The next in turn becomes the active one; only when waiting() > 0.
    void activate_next() noexcept {
        active_ = ring_[first_];
        first_ = (first_ + 1) % capacity;
        --waiting_;
    }
    void finish_active(Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        if (active_.id != 0) record(active_.id, outcome, error);
        active_ = {};
    }
    void finish_waiting(Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        for (std::size_t i = 0; i < waiting_; ++i) record(ring_[(first_ + i) % capacity].id, outcome, error);
        waiting_ = 0;
    }
    void record(CommandId id, Outcome outcome, ErrorId error = ErrorId::none) noexcept {
        ledger_[ledger_next_] = {id, outcome, error};
        ledger_next_ = static_cast<std::uint8_t>((ledger_next_ + 1) % ledger_.size());
    }

    void publish(GroupView& view) const noexcept {
        view.active = active_.id;
        view.active_kind = active_.command.kind;
        view.block = active_.command.instance;
        view.queued_count = static_cast<std::uint8_t>(waiting_);
        for (std::size_t i = 0; i < capacity; ++i) view.queued[i] = i < waiting_ ? ring_[(first_ + i) % capacity].id : 0;
        view.ledger = ledger_;
        view.ledger_next = ledger_next_;
        view.last_id = last_id_;
    }

private:
    AcceptedGroupCommand active_;
    std::array<AcceptedGroupCommand, capacity> ring_{};
    std::size_t first_ = 0, waiting_ = 0;
    decltype(GroupView::ledger) ledger_{};
    std::uint8_t ledger_next_ = 0;
    CommandId last_id_ = 0;
};

}  // namespace taktwerk::axes
