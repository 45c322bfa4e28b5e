// Logical addressing: each FMMU maps a run of logical bits to a run of physical bits.

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

namespace {

/// The part of an FMMU's run that lies in one datagram, in bits.
struct Overlap {
    std::uint64_t in_data = 0;   ///< first bit, counted from the datagram's data
    std::uint64_t physical = 0;  ///< first bit, counted from address 0
    std::uint64_t bits = 0;
    [[nodiscard]] bool whole_bytes() const noexcept { return ((in_data | physical | bits) & 7u) == 0; }
};

Overlap overlap(const Fmmu& fmmu, std::uint32_t logical, std::size_t size) noexcept {
    const std::uint64_t first = std::uint64_t{fmmu.logical_start} * 8 + fmmu.logical_start_bit;
    const std::uint64_t end = (std::uint64_t{fmmu.logical_start} + fmmu.length) * 8 - 7 + fmmu.logical_stop_bit;
    const std::uint64_t from = std::max(first, std::uint64_t{logical} * 8);
    const std::uint64_t to = std::min(end, (std::uint64_t{logical} + size) * 8);
    if (fmmu.length == 0 || from >= to) return {};
    return {from - std::uint64_t{logical} * 8, std::uint64_t{fmmu.physical_start} * 8 + fmmu.physical_start_bit + (from - first),
            to - from};
}

void copy_bits(std::span<std::byte> target, std::uint64_t to, std::span<const std::byte> source, std::uint64_t from,
               std::uint64_t bits) noexcept {
    for (std::uint64_t i = 0; i < bits; ++i) {
        const bool set = ((static_cast<unsigned>(source[(from + i) / 8]) >> ((from + i) % 8)) & 1u) != 0;
        const auto mask = static_cast<std::byte>(1u << ((to + i) % 8));
        auto& byte = target[(to + i) / 8];
        byte = set ? byte | mask : byte & ~mask;
    }
}

}  // namespace

void SlaveController::exchange_logical(MutableDatagram& datagram, Instant at) noexcept {
    if (datagram.command == Command::LRW && !settings_.lrw) return;
    const auto logical = load_le<std::uint32_t>(datagram.header, 2);
    bool was_written = false, was_read = false;
    // All writes take what the master sent, before any read replaces it.
    if (datagram.command != Command::LRD)
        for (unsigned n = 0; n < settings_.fmmus; ++n)
            if (fmmus_[n].active && fmmus_[n].write) was_written |= map_write(fmmus_[n], logical, datagram.data, at);
    if (datagram.command != Command::LWR)
        for (unsigned n = 0; n < settings_.fmmus; ++n)
            if (fmmus_[n].active && fmmus_[n].read) was_read |= map_read(fmmus_[n], logical, datagram.data, at);
    const unsigned for_write = datagram.command == Command::LRW ? 2 : 1;
    if (was_written || was_read) add_to_counter(datagram, (was_written ? for_write : 0) + (was_read ? 1 : 0));
}

bool SlaveController::map_write(const Fmmu& fmmu, std::uint32_t logical, std::span<const std::byte> data, Instant at) noexcept {
    const Overlap part = overlap(fmmu, logical, data.size());
    if (part.bits == 0) return false;
    const auto first = static_cast<std::uint32_t>(part.physical / 8);
    if (part.whole_bytes()) return write(first, data.subspan(part.in_data / 8, part.bits / 8), at);
    const std::size_t size = (part.physical + part.bits + 7) / 8 - first;
    std::array<std::byte, max_datagram_data + 1> merged;
    if (first + size > memory_.size() || size > merged.size()) return false;
    std::copy_n(memory_.begin() + first, size, merged.begin());
    copy_bits(merged, part.physical % 8, data, part.in_data, part.bits);
    return write(first, {merged.data(), size}, at);
}

bool SlaveController::map_read(const Fmmu& fmmu, std::uint32_t logical, std::span<std::byte> data, Instant at) noexcept {
    const Overlap part = overlap(fmmu, logical, data.size());
    if (part.bits == 0) return false;
    const auto first = static_cast<std::uint32_t>(part.physical / 8);
    if (part.whole_bytes()) return read(first, data.subspan(part.in_data / 8, part.bits / 8), at);
    const std::size_t size = (part.physical + part.bits + 7) / 8 - first;
    std::array<std::byte, max_datagram_data + 1> content;
    if (size > content.size() || !read(first, {content.data(), size}, at)) return false;
    copy_bits(data, part.in_data, content, part.physical % 8, part.bits);
    return true;
}

}  // namespace taktwerk::ecat::sim
