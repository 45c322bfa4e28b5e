#pragma once
// Records of about a second as one block of bytes, small: what is alike from cycle to cycle stands together. Records of one channel, one length and
// one place in their cycle are a class; of a class every byte is a column, each the difference to the record before, and zstd does the rest. So a
// machine that stands still costs next to nothing, and one that moves what is really new. A block is read without any other.
//
// Before zstd, little-endian: number of classes u16, of each channel u16, length u32, number of records u32; for each record in its order the
// class, low bytes of all, then high bytes; of each class the columns of its times (8), then those of its bytes.
//
// Not real-time.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "core/recorder.hpp"

namespace taktwerk::runtime {

/// With one record of the greatest length.
inline constexpr std::size_t most_block_bytes = std::size_t{32} << 20;
inline constexpr std::size_t most_record_bytes = std::size_t{16} << 20;

class RecordPacker {
public:
    /// `beat`: the channel whose record begins a cycle.
    explicit RecordPacker(RecordChannel beat) : beat_(beat) {}

    /// At most most_record_bytes long.
    void add(const RecordView& record);
    /// It is worth a block, or as much as one can have.
    [[nodiscard]] bool full() const noexcept;
    [[nodiscard]] std::size_t records() const noexcept { return order_.size(); }
    /// What was added, packed; then it is empty again.
    [[nodiscard]] std::vector<std::byte> take();

private:
    struct Class {
        RecordChannel channel = 0;
        std::uint32_t length = 0;
        std::vector<std::int64_t> times;
        std::vector<std::byte> rows;
    };
    using Kind = std::pair<RecordChannel, std::size_t>;

    RecordChannel beat_;
    std::map<Kind, std::uint16_t> in_this_cycle_;
    std::map<std::tuple<RecordChannel, std::size_t, std::uint16_t>, std::uint16_t> class_of_;
    std::vector<Class> classes_;
    std::vector<std::uint16_t> order_;
    std::size_t bytes_ = 0;
    std::vector<std::byte> plain_;
};

/// The records of a block again.
class UnpackedBlock {
public:
    /// False: damaged. `records`: so many it has; `channels`: a channel is less than this.
    [[nodiscard]] bool unpack(std::span<const std::byte> packed, std::size_t records, std::size_t channels);
    [[nodiscard]] std::size_t size() const noexcept { return records_.size(); }
    [[nodiscard]] RecordView record(std::size_t index) const noexcept;

private:
    struct Place {
        RecordChannel channel;
        std::int64_t time;
        std::size_t offset, length;
    };
    std::vector<Place> records_;
    std::vector<std::byte> bytes_, plain_;
};

}  // namespace taktwerk::runtime
