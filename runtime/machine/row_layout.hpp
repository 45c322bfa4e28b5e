#pragma once
// Where each signal of a machine stands in a row, in the order in which RowWriter puts them. Not real-time.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/machine_config.hpp"
#include "runtime/recording/recorded_signal.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class RowLayout {
public:
    void add_machine();
    void add_tasks(const MachineLayout& layout);
    void add_axes(const MachineLayout& layout);
    void add_groups(const MachineLayout& layout);
    /// Those of `bits` (by place in `names`) come first and share words; a word for each of the others.
    void add_points(SignalGroup group, const std::vector<std::string>& names, const std::vector<std::string>& units,
                    const std::vector<std::uint16_t>& bits);
    void add_variables(const MachineLayout& layout);

    [[nodiscard]] std::size_t words() const noexcept { return words_; }
    /// In the order of the columns of a trace; those that no trace shows stand beside what they are about.
    [[nodiscard]] std::vector<RecordedSignal> take_signals() { return std::move(signals_); }

private:
    std::vector<RecordedSignal> signals_;
    std::size_t words_ = 0;
};

/// How many rows the memory has: 1 at least.
[[nodiscard]] std::size_t rows_of(const RecordingConfig& recording, Duration cycle);

}  // namespace taktwerk::runtime
