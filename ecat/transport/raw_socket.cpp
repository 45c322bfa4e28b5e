#include "ecat/transport/raw_socket.hpp"

#include <fmt/format.h>
#include <linux/errqueue.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "core/calendar_distance.hpp"
#include "ecat/transport/descriptor.hpp"
#include "ecat/transport/network_interface.hpp"

namespace taktwerk::ecat {

namespace {

std::int64_t nanoseconds(Instant t) noexcept { return t.time_since_epoch().count(); }

std::int64_t nanoseconds(const timespec& t) noexcept { return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec; }

template <class Value>
std::optional<Value> control_value(msghdr& message, int level, int type) noexcept {
    for (auto* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
        if (part->cmsg_level != level || part->cmsg_type != type) continue;
        Value value{};
        std::memcpy(&value, CMSG_DATA(part), sizeof value);
        return value;
    }
    return std::nullopt;
}

/// The kernel's own stamp of a frame, in its real-time clock.
std::optional<std::int64_t> stamp_of(msghdr& message) noexcept {
    const auto stamps = control_value<scm_timestamping>(message, SOL_SOCKET, SCM_TIMESTAMPING);
    if (!stamps || stamps->ts[0].tv_sec == 0) return std::nullopt;
    return nanoseconds(stamps->ts[0]);
}

/// Which of the frames sent a stamp belongs to.
std::optional<std::uint32_t> number_of(msghdr& message) noexcept {
    const auto error = control_value<sock_extended_err>(message, SOL_PACKET, PACKET_TX_TIMESTAMP);
    return error ? std::optional{error->ee_data} : std::nullopt;
}

/// Is there a socket for EtherCAT frames on the interface besides `own`? packet(7): only who may send raw frames can have one. Where the kernel
/// does not show them: yes.
bool another_listens(unsigned interface, int own) {
    struct stat mine {};
    std::ifstream sockets("/proc/thread-self/net/packet");
    std::string line;
    if (::fstat(own, &mine) != 0 || !std::getline(sockets, line)) return true;
    while (std::getline(sockets, line)) {
        unsigned protocol = 0, at = 0;
        unsigned long inode = 0;
        if (std::sscanf(line.c_str(), "%*s %*u %*u %x %u %*u %*u %*u %lu", &protocol, &at, &inode) != 3) continue;
        if (protocol == ethertype && at == interface && inode != mine.st_ino) return true;
    }
    return false;
}

/// Abstract Unix sockets are per network namespace, as interfaces are, and vanish with their process. But everybody may have one: `socket` has
/// been bound before, so whoever holds the lock without a socket of that kind is no master, and nobody is held up by him: -1, with a remark.
Result<int> lock_interface(std::string_view interface, unsigned index, int socket, RawSocketReport& report) {
    Descriptor lock{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
    if (lock.get() < 0) return socket_error(interface, "creating the lock");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const auto name = fmt::format("taktwerk.nic.{}", interface);
    std::copy(name.begin(), name.end(), address.sun_path + 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (::bind(lock.get(), reinterpret_cast<const sockaddr*>(&address), size) == 0 && ::listen(lock.get(), 1) == 0) return lock.release();
    if (errno != EADDRINUSE) return socket_error(interface, "taking the lock");

    // The holder's process id: the kernel knows who listens.
    ucred holder{};
    socklen_t holder_size = sizeof holder;
    const Descriptor asker{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
    const bool known = ::connect(asker.get(), reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                       ::getsockopt(asker.get(), SOL_SOCKET, SO_PEERCRED, &holder, &holder_size) == 0 && holder.pid > 0;
    if (!another_listens(index, socket)) {
        report.refused.push_back(fmt::format("no lock against a second master: {} holds its name \"{}\" and is no master",
                                             known ? fmt::format("process {} of user {}", holder.pid, holder.uid) : "a process", name));
        return -1;
    }
    return interface_error("transport.in_use", interface,
                           known ? fmt::format("another Taktwerk is the master on it (process {})", holder.pid)
                                 : std::string{"another Taktwerk is the master on it (its process id is not visible from here)"},
                           "end that process, or use another interface");
}

}  // namespace

Result<std::unique_ptr<RawSocketTransport>> RawSocketTransport::open(std::string_view interface, const RawSocketOptions& options) {
    // Flags and hardware address can be asked without privilege: their errors come first.
    const auto found = find_interface(interface);
    if (!found) return found.error();
    auto opened = open_packet_socket(interface);
    if (!opened) return std::move(opened).error();
    Descriptor socket{std::move(opened).value()};

    RawSocketReport report = apply(options, socket.get(), interface);

    if (!bind_packet_socket(socket.get(), *found, ethertype)) return socket_error(interface, "binding the packet socket");

    Descriptor lock{-1};
    if (options.exclusive) {
        auto taken = lock_interface(interface, found->index, socket.get(), report);
        if (!taken) return std::move(taken).error();
        lock = Descriptor{*taken};
    }

    std::unique_ptr<RawSocketTransport> transport{
        new RawSocketTransport{std::string{interface}, socket.release(), lock.release(), found->mac, std::move(report)}};
    transport->clock_ = options.clock;
    transport->refresh();
    return transport;
}

RawSocketTransport::RawSocketTransport(std::string interface, int socket, int lock, const MacAddress& mac, RawSocketReport report) noexcept
    : interface_(std::move(interface)), socket_(socket), lock_(lock), mac_(mac), report_(std::move(report)) {}

RawSocketTransport::~RawSocketTransport() {
    ::close(socket_);
    if (lock_ >= 0) ::close(lock_);
}

bool RawSocketTransport::send(std::span<const std::byte> frame, Instant now) noexcept {
    if (clock_ != nullptr) departed_ = clock_->now();
    if (::send(socket_, frame.data(), frame.size(), MSG_DONTWAIT) != static_cast<ssize_t>(frame.size())) return false;
    if (report_.stamps_sending) sent_at_ns_[next_send_++ % remembered_sends].store(nanoseconds(now), std::memory_order_relaxed);
    return true;
}

std::optional<ReceivedFrame> RawSocketTransport::receive(std::span<std::byte> buffer, Instant now) noexcept {
    constexpr int own_frames_skipped = 16;  // at most so many are between two answers
    for (int i = 0; i < own_frames_skipped; ++i) {
        sockaddr_ll from{};
        iovec data{buffer.data(), buffer.size()};
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(scm_timestamping))> control{};
        msghdr message{};
        message.msg_name = &from;
        message.msg_namelen = sizeof from;
        message.msg_iov = &data;
        message.msg_iovlen = 1;
        message.msg_control = report_.stamps_receipt ? control.data() : nullptr;
        message.msg_controllen = report_.stamps_receipt ? control.size() : 0;
        const auto size = ::recvmsg(socket_, &message, MSG_DONTWAIT);
        if (size <= 0) return std::nullopt;
        if (report_.sees_own_frames && from.sll_pkttype == PACKET_OUTGOING) continue;
        const auto stamp = stamp_of(message);
        return ReceivedFrame{static_cast<std::size_t>(size), stamp ? arrival(*stamp, now) : now};
    }
    return std::nullopt;
}

Instant RawSocketTransport::arrival(std::int64_t stamp_ns, Instant asked) const noexcept {
    // A frame may come in after the cycle looked at its clock and before it asked.
    constexpr Duration most_ahead = std::chrono::milliseconds{5}, most_behind = std::chrono::seconds{1};
    const Instant at{Duration{stamp_ns - realtime_minus_machine_ns_.load(std::memory_order_relaxed)}};
    return at <= asked + most_ahead && at >= asked - most_behind ? at : asked;
}

void RawSocketTransport::refresh() noexcept {
    read_carrier();
    if (report_.stamps_receipt || report_.stamps_sending)
        realtime_minus_machine_ns_.store(calendar_minus_machine_time().count(), std::memory_order_relaxed);
    read_drops();
    if (report_.stamps_sending) read_send_stamps();
}

void RawSocketTransport::read_carrier() noexcept { link_up_.store(has_carrier(socket_, interface_), std::memory_order_relaxed); }

std::optional<Error> RawSocketTransport::link_trouble() const {
    if (link_up()) return std::nullopt;
    const auto found = find_interface(interface_);
    return found ? std::nullopt : std::optional{found.error()};
}

void RawSocketTransport::read_drops() noexcept {
    tpacket_stats counted{};  // since the last call
    socklen_t size = sizeof counted;
    if (::getsockopt(socket_, SOL_PACKET, PACKET_STATISTICS, &counted, &size) != 0) return;
    statistics_.received += counted.tp_packets - counted.tp_drops;
    statistics_.dropped += counted.tp_drops;
}

void RawSocketTransport::read_send_stamps() noexcept {
    for (std::size_t i = 0; i < remembered_sends; ++i) {
        alignas(cmsghdr) std::array<char, 256> control{};
        msghdr message{};
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        if (::recvmsg(socket_, &message, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return;
        const auto stamp = stamp_of(message);
        const auto number = number_of(message);
        if (!stamp || !number) continue;
        const auto sent = sent_at_ns_[*number % remembered_sends].load(std::memory_order_relaxed);
        statistics_.send_delay = Duration{*stamp - realtime_minus_machine_ns_.load(std::memory_order_relaxed) - sent};
        statistics_.longest_send_delay = std::max(statistics_.longest_send_delay, statistics_.send_delay);
        ++statistics_.stamped;
    }
}

}  // namespace taktwerk::ecat
