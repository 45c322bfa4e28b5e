#pragma once
// MC_StepReferencePulse: the first reference pulse on the way. A pulse that the drive latches is exact; one that is an input of the machine
// must be longer than a cycle and is taken half way between two samples. Real-time safe.

#include "axes/homing/search.hpp"

namespace taktwerk::axes {

class PulseSearch {
public:
    PulseSearch() = default;
    explicit PulseSearch(bool positive) noexcept : positive_(positive) {}

    [[nodiscard]] SearchMove step(const SearchInput& in) noexcept {
        edge_.see(in.signal, in.position);
        if (in.latched) return SearchMove::found(in.latch);
        if (edge_.rising()) return SearchMove::found(edge_.place());
        if (positive_ ? in.positive_limit : in.negative_limit) return SearchMove::failed();
        return SearchMove::along(positive_ ? 1 : -1, true);
    }

private:
    bool positive_ = true;
    EdgeWatch edge_;
};

}  // namespace taktwerk::axes
