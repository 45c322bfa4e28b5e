#pragma once
// A program in G-code as a stored path. Service side; the text stands in memory and is shared.

#include <memory>
#include <string>

#include "axes/group/path_source.hpp"
#include "fb_library/gcode/interpreter_options.hpp"

namespace taktwerk::gcode {

class GcodePathMaker final : public axes::PathMaker {
public:
    /// `options`: tools, offsets, reference positions, units; how it is run comes with begin(). A, B, C are refused: a group's path has no meaning for them yet.
    GcodePathMaker(std::shared_ptr<const std::string> text, InterpreterOptions options);
    ~GcodePathMaker() override;

    void begin(const axes::PathOptions& options, const std::array<double, 3>& start, double millimetre) override;
    [[nodiscard]] std::optional<axes::PathMade> step() override;

private:
    struct Look;
    std::shared_ptr<const std::string> text_;
    InterpreterOptions options_;
    std::unique_ptr<Look> look_;
};

}  // namespace taktwerk::gcode
