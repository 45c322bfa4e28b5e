#pragma once
// A recording step by step: a cycle, or what was done beside it, with all its records. Not real-time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "runtime/recording_file/recording.hpp"

namespace taktwerk::runtime {

class StepReader {
public:
    explicit StepReader(RecordSource& source) : source_(source) {}
    StepReader(StepReader&&) = default;  // what it hands out stays where it is
    StepReader(const StepReader&) = delete;
    StepReader& operator=(const StepReader&) = delete;

    /// What stands before the first step: call it first, and once.
    [[nodiscard]] Result<void> read_start() { return read(); }
    /// False: there is no further one. One that was cut off, at the end of a recording without an end, does not count.
    [[nodiscard]] Result<bool> next();

    /// Of this step, the one that begins it first; or what stands before the first. Valid until the next one.
    [[nodiscard]] std::span<const RecordView> records() const noexcept { return records_; }
    /// How many records stood before this step.
    [[nodiscard]] std::uint64_t first() const noexcept { return first_; }

    [[nodiscard]] static bool begins_a_step(RecordChannel channel) noexcept;

private:
    struct Place {
        RecordChannel channel;
        Instant time;
        std::size_t offset, length;
    };
    [[nodiscard]] Result<void> read();
    void keep(const RecordView& record);

    RecordSource& source_;
    std::vector<std::byte> bytes_;
    std::vector<Place> places_;
    std::vector<RecordView> records_;
    std::vector<std::byte> next_bytes_;  // of the record that begins the next step
    RecordView next_;
    bool has_next_ = false;
    std::uint64_t first_ = 0;
};

}  // namespace taktwerk::runtime
