#include "ecat/transport/xdp_socket.hpp"

#include <sys/mman.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "core/clock.hpp"
#include "ecat/transport/xdp_program.hpp"

namespace taktwerk::ecat {

Mapping::~Mapping() {
    if (data_ != nullptr) ::munmap(data_, size_);
}

bool Mapping::map(std::size_t size, int descriptor, std::uint64_t offset) noexcept {
    const int kind = descriptor < 0 ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
    void* const mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, kind | MAP_POPULATE, descriptor, static_cast<off_t>(offset));
    if (mapped == MAP_FAILED) return false;
    data_ = static_cast<std::byte*>(mapped);
    size_ = size;
    return true;
}

Result<std::unique_ptr<XdpSocket>> XdpSocket::open(std::string_view interface, unsigned index) {
    // The kernel gives a queue free some time after who had it is gone: a run that follows the last one waits for it, longer where every CPU is busy.
    constexpr Duration patience = std::chrono::seconds{1}, pause = std::chrono::milliseconds{5};
    SystemClock clock;
    const Instant end = clock.now() + patience;
    for (;;) {
        Descriptor socket{::socket(AF_XDP, SOCK_RAW | SOCK_CLOEXEC, 0)};
        if (socket.get() < 0) return no_xdp(interface, "opening its socket", errno);
        std::unique_ptr<XdpSocket> made{new XdpSocket{std::move(socket)}};
        const auto failed = made->set_up(index);
        if (failed.empty()) return made;
        const int number = errno;
        if (number != EBUSY || clock.now() > end) return no_xdp(interface, failed, number);
        made.reset();
        clock.sleep_until(clock.now() + pause);
    }
}

std::string_view XdpSocket::set_up(unsigned index) noexcept {
    const int socket = socket_.get();
    const auto set = [socket](int option, const auto& value) { return ::setsockopt(socket, SOL_XDP, option, &value, sizeof value) == 0; };
    constexpr std::size_t bytes = std::size_t{receive_places + send_places} * place_size;
    if (!frames_.map(bytes, -1, 0)) return "getting memory for frames";
    xdp_umem_reg memory{};
    memory.addr = reinterpret_cast<std::uintptr_t>(frames_.data());
    memory.len = bytes;
    memory.chunk_size = place_size;
    if (!set(XDP_UMEM_REG, memory)) return "locking memory for frames";
    const std::uint32_t many = receive_places, few = send_places;
    if (!set(XDP_UMEM_FILL_RING, many) || !set(XDP_UMEM_COMPLETION_RING, few) || !set(XDP_RX_RING, many) || !set(XDP_TX_RING, few))
        return "making its rings";
    xdp_mmap_offsets at{};
    socklen_t size = sizeof at;
    if (::getsockopt(socket, SOL_XDP, XDP_MMAP_OFFSETS, &at, &size) != 0) return "asking for its rings";
    if (!fill_.map(socket, XDP_UMEM_PGOFF_FILL_RING, at.fr, many) || !completion_.map(socket, XDP_UMEM_PGOFF_COMPLETION_RING, at.cr, few) ||
        !receive_.map(socket, XDP_PGOFF_RX_RING, at.rx, many) || !transmit_.map(socket, XDP_PGOFF_TX_RING, at.tx, few))
        return "mapping its rings";
    for (std::uint32_t i = 0; i < receive_places; ++i) fill_.at(filled_++) = std::uint64_t{i} * place_size;
    fill_.produce_up_to(filled_);
    for (std::uint32_t i = 0; i < send_places; ++i) free_[free_count_++] = std::uint64_t{receive_places + i} * place_size;

    sockaddr_xdp address{};
    address.sxdp_family = AF_XDP;
    address.sxdp_flags = XDP_COPY | XDP_USE_NEED_WAKEUP;
    address.sxdp_ifindex = index;
    address.sxdp_queue_id = 0;
    return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? "" : "taking queue 0";
}

void XdpSocket::take_sent() noexcept {
    const std::uint32_t done = completion_.produced();
    if (done == completed_) return;
    while (completed_ != done) free_[free_count_++] = completion_.at(completed_++);
    completion_.consume_up_to(completed_);
}

bool XdpSocket::send(std::span<const std::byte> frame) noexcept {
    take_sent();
    if (frame.size() > place_size) return false;
    if (!not_taken_) {
        if (free_count_ == 0) return false;
        not_taken_ = free_[--free_count_];
    }
    std::memcpy(frames_.data() + *not_taken_, frame.data(), frame.size());
    transmit_.at(sent_) = xdp_desc{*not_taken_, static_cast<__u32>(frame.size()), 0};
    transmit_.produce_up_to(sent_ + 1);
    const bool left = !transmit_.needs_wakeup() || ::sendto(socket_.get(), nullptr, 0, MSG_DONTWAIT, nullptr, 0) >= 0;
    // EBUSY: the driver threw it away, no carrier for instance. After every other error it stands where it is, until the next frame is written over it.
    if (!left && errno != EBUSY) return false;
    ++sent_;
    not_taken_.reset();
    return left;
}

std::optional<XdpSocket::Arrived> XdpSocket::receive(std::span<std::byte> buffer) noexcept {
    if (receive_.produced() == received_) {
        if (fill_.needs_wakeup()) (void)::recvfrom(socket_.get(), nullptr, 0, MSG_DONTWAIT, nullptr, nullptr);
        return std::nullopt;
    }
    const xdp_desc frame = receive_.at(received_++);
    Arrived arrived{std::min<std::size_t>(frame.len, buffer.size()), 0};
    std::byte* const data = frames_.data() + frame.addr;
    std::memcpy(buffer.data(), data, arrived.size);
    const std::uint64_t place = frame.addr & ~std::uint64_t{place_size - 1};
    if (frame.addr - place >= sizeof arrived.stamp_ns) {
        std::byte* const stamp = data - sizeof arrived.stamp_ns;
        std::memcpy(&arrived.stamp_ns, stamp, sizeof arrived.stamp_ns);
        std::memset(stamp, 0, sizeof arrived.stamp_ns);  // the next frame of this place may come undated
    }
    receive_.consume_up_to(received_);
    fill_.at(filled_++) = place;
    fill_.produce_up_to(filled_);
    return arrived;
}

std::uint64_t XdpSocket::dropped() const noexcept {
    xdp_statistics counted{};
    socklen_t size = sizeof counted;
    if (::getsockopt(socket_.get(), SOL_XDP, XDP_STATISTICS, &counted, &size) != 0) return 0;
    return counted.rx_dropped + counted.rx_ring_full;  // no place to write to is in the first one
}

}  // namespace taktwerk::ecat
