#pragma once
// The program that the kernel runs on every frame an interface receives, before its own stack sees it: what is EtherCAT (88A4h) goes to the
// AF_XDP socket of the queue it came by, with the instant of its arrival in the 8 bytes before it; everything else goes where it would go anyway.
//
// 28 instructions, written here and loaded with bpf(2). libxdp would bring a program too, but one that takes every frame of the queue, ping and ssh
// with it, and another one around it that needs the kernel's type information; a program of one's own in C needs clang in the build. No library, then.
//
// It hangs on a link (Linux 5.9): the kernel takes it off when the process ends, however it ends. Linux only; not real-time.

#include <string>
#include <string_view>

#include "core/result.hpp"
#include "ecat/transport/descriptor.hpp"

namespace taktwerk::ecat {

class XdpProgram {
public:
    /// Where it is asked: by the driver, before the kernel makes a packet of the frame, or by the stack behind it, which every driver has.
    enum class Place { driver, stack };
    /// In which places it may be put.
    enum class Places { driver, stack, driver_or_stack };

    /// Loads it; nothing hangs on it yet. Errors: transport.no_xdp.
    [[nodiscard]] static Result<XdpProgram> load(std::string_view interface);
    /// EtherCAT that comes by queue 0 goes to this AF_XDP socket. False: errno says why.
    [[nodiscard]] bool hand_to(int socket) noexcept;
    /// From now on, until this object or the process ends. Returns where. Errors: transport.no_xdp, transport.xdp_taken (somebody else's program
    /// is there).
    [[nodiscard]] Result<Place> attach(unsigned index, Places places);

private:
    XdpProgram(std::string interface, Descriptor sockets, Descriptor program)
        : interface_(std::move(interface)), sockets_(std::move(sockets)), program_(std::move(program)) {}

    std::string interface_;
    Descriptor sockets_;  ///< map: queue -> AF_XDP socket
    Descriptor program_;
    Descriptor link_;
};

/// transport.no_xdp: what was tried, why not (from `number`, an errno), what to do.
[[nodiscard]] Error no_xdp(std::string_view interface, std::string_view tried, int number);

}  // namespace taktwerk::ecat
