#pragma once
// The variables of a program without a base task, as its slow task leaves them: read after a run, shown when the run is applied.

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "runtime/tasks/program_host.hpp"

namespace taktwerk::runtime {

class VariableCopy {
public:
    explicit VariableCopy(std::vector<ProgramHost::Variable> sources)
        : sources_(std::move(sources)), read_(sources_.size()), applied_(sources_.size()) {}

    /// By the task, after a run.
    void read() noexcept {
        for (std::size_t i = 0; i < sources_.size(); ++i) read_[i] = ProgramHost::read(sources_[i]);
    }
    /// By the cycle.
    void apply() noexcept { std::copy(read_.begin(), read_.end(), applied_.begin()); }
    [[nodiscard]] std::span<const double> applied() const noexcept { return applied_; }

private:
    std::vector<ProgramHost::Variable> sources_;
    std::vector<double> read_, applied_;
};

}  // namespace taktwerk::runtime
