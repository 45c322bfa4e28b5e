#include "hmi_bridge/lcm/whole_states.hpp"

#include <utility>

#include "hmi_bridge/lcm/whole_message.hpp"

namespace taktwerk::hmi {

void WholeStates::receive(std::span<const std::byte> message, Instant at) {
    const auto head = head_of_whole_state(message);
    if (!head) {
        ++refused_;
        return;
    }
    if (head->run != run_) {
        ++foreign_;
        return;
    }
    if (head->publication <= newest_) return;
    if (newest_ != 0) {
        const auto ahead = head->publication - newest_;
        if (ahead > most_at_once + static_cast<std::int64_t>(to_seconds(at - came_) * most_a_second)) {
            ++refused_;
            return;
        }
        if (!looked_away_) lost_ += static_cast<std::uint64_t>(ahead - 1);
    }
    looked_away_ = false;
    newest_ = head->publication;
    bytes_.assign(message.begin(), message.end());
    waits_ = true;
    came_ = at;
}

std::optional<taktwerk_lcm::whole_state_v5_t> WholeStates::take() {
    if (!std::exchange(waits_, false)) return std::nullopt;
    auto state = read_whole_state(bytes_);
    if (state) return std::move(*state);
    ++refused_;
    return std::nullopt;
}

}  // namespace taktwerk::hmi
