#pragma once
// A carriage on a rail without ramps: 10 counts per step in the sense a search asks for. A switch between two places, limit switches at both ends.

#include "axes/homing/search.hpp"

namespace taktwerk::axes::test {

struct Rail {
    static constexpr std::int64_t speed = 10;  ///< counts per step

    std::int64_t position = 0;
    std::int64_t switch_from = 1, switch_to = 0;  ///< on in between, both included
    std::int64_t negative_end = -10'000, positive_end = 10'000;
    int steps = 0;
    SearchInput in{};

    [[nodiscard]] const SearchInput& look() {
        in.signal = position >= switch_from && position <= switch_to;
        in.negative_limit = position <= negative_end;
        in.positive_limit = position >= positive_end;
        in.position = position;
        return in;
    }
    /// Runs until the search ends; its last answer.
    template <class Search>
    SearchMove run(Search& search, int most = 20'000) {
        for (; steps < most; ++steps) {
            const auto move = search.step(look());
            if (move.kind != SearchMove::Kind::move) return move;
            in.set_velocity = move.sense;
            position += move.sense * speed;
            in.now += std::chrono::milliseconds{1};
        }
        return SearchMove::failed();
    }
};

}  // namespace taktwerk::axes::test
