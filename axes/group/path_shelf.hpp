#pragma once
// The stored paths of a machine: the cycle asks for one to be prepared, the service side prepares it, the cycle takes note of it. Groups find it here by
// its place.

#include <cstdint>
#include <memory>
#include <vector>

#include "axes/group/path_source.hpp"
#include "core/spsc_ring.hpp"

namespace taktwerk::axes {

class PathShelf {
public:
    PathShelf() = default;
    PathShelf(const PathShelf&) = delete;
    PathShelf& operator=(const PathShelf&) = delete;

    /// Before anything runs. `maker`: of one path, whose place is that in the order of the calls.
    void add(std::unique_ptr<PathMaker> maker);
    [[nodiscard]] std::size_t size() const noexcept { return states_.size(); }

    // The cycle's side: real-time safe.

    /// Begins to prepare it. The ticket; 0: not now, too many at once.
    std::uint32_t select(PathRef path, const PathOptions& options, const std::array<double, 3>& start, double millimetre) noexcept;
    /// nullptr: there is none of that place.
    [[nodiscard]] const PathState* state(PathRef path) const noexcept {
        return path.index < states_.size() ? &states_[path.index] : nullptr;
    }
    /// Takes note of what has been prepared. Once a cycle.
    void take_answers() noexcept;

    // The service side: the thread of the groups' planners.

    /// A bounded piece of the work.
    void service();
    /// As prepared last; nullptr: it is not.
    [[nodiscard]] std::shared_ptr<const PathProgram> program(PathRef path) const {
        return path.index < programs_.size() ? programs_[path.index] : nullptr;
    }

private:
    struct Wanted {
        PathRef path{};
        std::uint32_t ticket = 0;
        PathOptions options{};
        std::array<double, 3> start{};
        double millimetre = 1;
    };
    struct Answer {
        PathRef path{};
        PathState state{};
    };

    std::vector<PathState> states_;  // the cycle's
    std::uint32_t tickets_ = 0;
    SpscRing<Wanted> wanted_{16};
    SpscRing<Answer> answers_{16};
    // The service's.
    std::vector<std::unique_ptr<PathMaker>> makers_;
    std::vector<std::shared_ptr<const PathProgram>> programs_;
    Wanted at_;
    bool working_ = false, unsaid_ = false;
    Answer answer_;
};

}  // namespace taktwerk::axes
