#pragma once
// What an AF_XDP socket shares with the kernel: a memory of frames (UMEM) and four rings that say whose turn each of them is. Written by one thread
// of ours and by the kernel. Set up once, and then only loads, stores and copies: real-time safe but for make(). Linux's
// Documentation/networking/af_xdp.rst.
//
//   fill        we -> kernel   places for frames to come
//   receive     kernel -> we   frames that came
//   transmit    we -> kernel   frames to send
//   completion  kernel -> we   places of frames that were sent

#include <linux/if_xdp.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "ecat/transport/descriptor.hpp"

namespace taktwerk::ecat {

/// Memory that unmaps itself.
class Mapping {
public:
    Mapping() noexcept = default;
    ~Mapping();
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    /// Once, all of it present. `descriptor` -1: memory of our own. False: errno says why.
    [[nodiscard]] bool map(std::size_t size, int descriptor, std::uint64_t offset) noexcept;
    [[nodiscard]] std::byte* data() const noexcept { return data_; }

private:
    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

/// Of a power of two of entries; counters run freely. One side of it is ours.
template <class Entry>
class XdpRing {
public:
    /// False: errno says why.
    [[nodiscard]] bool map(int socket, std::uint64_t page, const xdp_ring_offset& at, std::uint32_t entries) noexcept {
        if (!memory_.map(at.desc + entries * sizeof(Entry), socket, page)) return false;
        producer_ = word(at.producer);
        consumer_ = word(at.consumer);
        flags_ = word(at.flags);
        entries_ = reinterpret_cast<Entry*>(memory_.data() + at.desc);
        mask_ = entries - 1;
        return true;
    }
    [[nodiscard]] Entry& at(std::uint32_t count) const noexcept { return entries_[count & mask_]; }
    /// Everything that was written to entries below is there.
    [[nodiscard]] std::uint32_t produced() const noexcept { return std::atomic_ref{*producer_}.load(std::memory_order_acquire); }
    [[nodiscard]] std::uint32_t consumed() const noexcept { return std::atomic_ref{*consumer_}.load(std::memory_order_acquire); }
    void produce_up_to(std::uint32_t count) noexcept { std::atomic_ref{*producer_}.store(count, std::memory_order_release); }
    void consume_up_to(std::uint32_t count) noexcept { std::atomic_ref{*consumer_}.store(count, std::memory_order_release); }
    /// The kernel sleeps over it and wants a system call.
    [[nodiscard]] bool needs_wakeup() const noexcept {
        return (std::atomic_ref{*flags_}.load(std::memory_order_relaxed) & XDP_RING_NEED_WAKEUP) != 0;
    }

private:
    [[nodiscard]] std::uint32_t* word(std::uint64_t offset) const noexcept {
        return reinterpret_cast<std::uint32_t*>(memory_.data() + offset);
    }
    Mapping memory_;
    std::uint32_t *producer_ = nullptr, *consumer_ = nullptr, *flags_ = nullptr;
    Entry* entries_ = nullptr;
    std::uint32_t mask_ = 0;
};

}  // namespace taktwerk::ecat
