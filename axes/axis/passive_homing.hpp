#pragma once
// Passive homing (PLCopen Part 5, flying steps): the axis does what it was told anyway, and when the reference passes by its coordinates are
// set by it. The number of an absolute target stays, so the way to it changes. No state changes; one at a time, a new one replaces the old.

#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/command.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/homing/search.hpp"

namespace taktwerk::axes {

class Aim;
class HomingReference;
class HomingSteps;

class PassiveHoming {
public:
    PassiveHoming(AxisBody& body, const Measured& measured, Aim& aim, HomingRuns& runs, HomingReference& reference,
                  const HomingSteps& steps) noexcept
        : body_(body), measured_(measured), aim_(aim), runs_(runs), reference_(reference), steps_(steps) {}

    Submitted submit(const AxisCommand& command) noexcept;
    void watch() noexcept;

    [[nodiscard]] CommandId id() const noexcept { return passive_.id; }

private:
    [[nodiscard]] ErrorId refuse(const AxisCommand& command) const noexcept;
    void end(Outcome outcome, ErrorId error = ErrorId::none) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    Aim& aim_;
    HomingRuns& runs_;
    HomingReference& reference_;
    const HomingSteps& steps_;
    struct Watched {
        CommandId id = 0;
        HomingStepDetails step;
        EdgeWatch edge{};
        Instant since{};
        std::int64_t from = 0;  // counts
    };
    Watched passive_;
};

}  // namespace taktwerk::axes
