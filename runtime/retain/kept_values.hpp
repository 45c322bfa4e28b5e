#pragma once
// What was kept and what the programs of today declare: the one put into the other, by name and type, with a report of what was added, is
// without a variable, was converted, or does not fit. And back: the bytes of a moment as what is to be kept. Service side, not real-time.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/machine_config.hpp"
#include "runtime/retain/kept.hpp"
#include "runtime/retain/retain_note.hpp"
#include "runtime/retain/retained_item.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

/// The variables that people write have ranges, which a kept value must lie in, too.
struct RetainBound {
    const void* address = nullptr;
    const MachineLayout::Variable* variable = nullptr;
};

class KeptValues {
public:
    static constexpr std::size_t most_unclaimed = 4096;        ///< values, parameters; those that have been it the longest go first
    static constexpr std::size_t most_unclaimed_blocks = 256;  ///< likewise

    /// `items` and `parameters` stay where they are.
    KeptValues(std::span<const RetainedItem> items, std::span<const MachineLayout::ParameterInfo> parameters)
        : items_(items), parameters_(parameters) {}

    /// Puts what fits of `kept` into the variables and into `values` (of the parameters). Before the first scan, once.
    std::vector<RetainNote> restore(const Kept& kept, RetainStart start, std::span<double> values, std::span<const RetainBound> bounds);

    /// Blocks whose bytes were taken as they are: they want fb::BlockType::warm_start before their next call. Places among the items.
    [[nodiscard]] const std::vector<std::size_t>& warm_blocks() const noexcept { return warm_; }

    /// `image`: the bytes of all items, one after the other; `values`: of the parameters. Adds to `out` what is to be written.
    void write(std::span<const std::byte> image, std::span<const double> values, Kept& out) const;

private:
    struct Found;
    RetainNote restore_value(const RetainedItem& item, const KeptValue* kept, std::span<const RetainBound> bounds);
    RetainNote restore_block(const RetainedItem& item, const Found& kept, const KeptBlock* block);
    void keep_unclaimed(const Kept& kept, RetainStart start, std::vector<RetainNote>& notes);

    std::span<const RetainedItem> items_;
    std::span<const MachineLayout::ParameterInfo> parameters_;
    std::vector<double> configured_;  // of the parameters
    std::vector<std::size_t> warm_;
    Kept aside_;  // what nobody claims
};

}  // namespace taktwerk::runtime
