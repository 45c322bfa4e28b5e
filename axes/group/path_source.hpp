#pragma once
// A path that is longer than any queue: what goes it pulls its pieces one by one, as far ahead as it has room. Service side; whoever writes paths in a
// language (fb_library/gcode_path/) implements it.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "axes/group/path_types.hpp"

namespace taktwerk::axes {

/// Places are of the tool's point in the machine, in u of the group's path.
struct PathItem {
    enum class Kind : std::uint8_t {
        line,
        arc,    ///< about an axis of the machine; along that axis it moves evenly with the angle
        dwell,  ///< at rest for `seconds`
        ask,    ///< at rest until `request` is acknowledged
        tell,   ///< `request` in its turn; nothing waits for it
        end,
        fault,  ///< `place` says why; nothing comes behind it
    } kind = Kind::end;
    std::uint32_t line = 0;  ///< of the text, from 1
    std::uint32_t number = PathView::no_block_number;

    std::array<double, 3> to{};
    std::array<double, 3> centre{};  ///< of an arc
    std::uint8_t normal = 2;         ///< of an arc: x 0, y 1, z 2
    double angle = 0;     ///< of an arc, rad: positive is the mathematical sense about the normal's positive direction; turns included
    double velocity = 0;  ///< u/s; 0: as fast as the axes may
    /// How the joint in front of it is passed: at rest; without a curve, at rest unless both are smooth there; on a curve no further from it than
    /// `deviation` [u].
    enum class Joint : std::uint8_t { stop, exact, blend } joint = Joint::exact;
    double deviation = 0;

    double seconds = 0;
    PathRequest request{};
    PathPlace place{};
};

class PathSource {
public:
    PathSource() = default;
    PathSource(const PathSource&) = delete;
    PathSource& operator=(const PathSource&) = delete;
    virtual ~PathSource() = default;
    /// The next piece. Ends with `end` or `fault`, and is not asked again.
    virtual PathItem next() = 0;
};

/// A path as prepared: may be gone any number of times.
class PathProgram {
public:
    PathProgram() = default;
    PathProgram(const PathProgram&) = delete;
    PathProgram& operator=(const PathProgram&) = delete;
    virtual ~PathProgram() = default;
    /// From its beginning; the tool's point is at `start` [u].
    [[nodiscard]] virtual std::unique_ptr<PathSource> open(const std::array<double, 3>& start) const = 0;
};

struct PathMade {
    std::shared_ptr<const PathProgram> program;  ///< nullptr: `place` says why
    std::uint32_t lines = 0;
    PathPlace place{};
};

/// Reads a stored path and looks for everything that is wrong with it, before anything moves.
class PathMaker {
public:
    PathMaker() = default;
    PathMaker(const PathMaker&) = delete;
    PathMaker& operator=(const PathMaker&) = delete;
    virtual ~PathMaker() = default;
    /// Begins anew; `start` [u]: where the tool's point is now. `millimetre`: in u.
    virtual void begin(const PathOptions& options, const std::array<double, 3>& start, double millimetre) = 0;
    /// A bounded piece of the work. Nothing: go on.
    [[nodiscard]] virtual std::optional<PathMade> step() = 0;
};

}  // namespace taktwerk::axes
