#pragma once
// Another EtherCAT master on the cable, as small as one can be: a source address of its own, sound frames, one each two milliseconds.
// It has given the first slave a station address of its own and watches whether somebody takes it away.

#include <fcntl.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "core/bytes.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::apps {

class ForeignMaster {
public:
    static constexpr ecat::MacAddress address{0x02, 0x46, 0x4F, 0x52, 0x00, 0x42};
    static constexpr std::uint16_t station = 0x2042;

    /// `name_space`: of the cable's end that this master shares with the other.
    ForeignMaster(const std::string& name_space, const std::string& nic) : thread_([this, name_space, nic] { work(name_space, nic); }) {}
    ~ForeignMaster() {
        stop_.store(true);
        thread_.join();
    }
    ForeignMaster(const ForeignMaster&) = delete;
    ForeignMaster& operator=(const ForeignMaster&) = delete;

    /// Its slave answered to its address so often, and so often somebody else's hand was felt: no answer, or another state than INIT.
    [[nodiscard]] int answered() const noexcept { return answered_.load(); }
    [[nodiscard]] int disturbed() const noexcept { return disturbed_.load(); }

private:
    void work(const std::string& name_space, const std::string& nic) {
        const int there = ::open(("/var/run/netns/" + name_space).c_str(), O_RDONLY | O_CLOEXEC);
        if (there < 0 || ::setns(there, CLONE_NEWNET) != 0) return;
        ::close(there);
        constexpr std::uint16_t ethertype = 0xA488;  // 88A4h in network order
        const int wire = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, ethertype);
        sockaddr_ll at{};
        at.sll_family = AF_PACKET;
        at.sll_protocol = ethertype;
        at.sll_ifindex = static_cast<int>(::if_nametoindex(nic.c_str()));
        if (wire < 0 || ::bind(wire, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) return;

        bool owns = false;
        for (std::uint8_t index = 0; !stop_.load(); ++index) {
            std::array<std::byte, ecat::min_frame_size> buffer{};
            ecat::FrameBuilder builder{buffer, address};
            if (!owns)
                store_le(builder.add(ecat::Command::APWR, index, ecat::Address::position(0, ecat::reg::station_address), 2), 0, station);
            else (void)builder.add(ecat::Command::FPRD, index, ecat::Address::physical(station, ecat::reg::al_status), 2);
            (void)builder.finish();
            (void)::send(wire, buffer.data(), buffer.size(), 0);
            const int wkc = working_counter(wire, index);
            if (!owns) owns = wkc == 1;
            else if (wkc == 1) answered_.fetch_add(1);
            else disturbed_.fetch_add(1);
            std::this_thread::sleep_for(std::chrono::milliseconds{2});
        }
        ::close(wire);
    }
    /// Of the answer to the frame with this index; -1: none within half a second.
    int working_counter(int wire, std::uint8_t index) const {
        const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds{500};
        while (std::chrono::steady_clock::now() < until && !stop_.load()) {
            pollfd ready{wire, POLLIN, 0};
            if (::poll(&ready, 1, 50) <= 0) continue;
            std::array<std::byte, ecat::max_frame_size> in{};
            sockaddr_ll from{};
            socklen_t length = sizeof from;
            const auto size = ::recvfrom(wire, in.data(), in.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
            if (size <= 0 || from.sll_pkttype == PACKET_OUTGOING) continue;
            const bool ours = std::equal(address.begin() + 1, address.end(), in.begin() + 7,
                                         [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
            ecat::FrameReader reader{std::span{in}.first(static_cast<std::size_t>(size))};
            const auto datagram = reader.next();
            if (ours && datagram && datagram->index == index) return datagram->working_counter();
        }
        return -1;
    }

    std::atomic<bool> stop_{false};
    std::atomic<int> answered_{0}, disturbed_{0};
    std::thread thread_;
};

}  // namespace taktwerk::apps
