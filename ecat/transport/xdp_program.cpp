#include "ecat/transport/xdp_program.hpp"

#include <fmt/format.h>
#include <linux/bpf.h>
#include <linux/if_link.h>
#include <netinet/in.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "ecat/transport/network_interface.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {

namespace {

constexpr unsigned queues = 64;  // of the map; only the first is used

/// Registers: r0 result, r1..r5 arguments and scratch, r6..r9 kept over calls.
constexpr bpf_insn step(unsigned code, unsigned destination, unsigned source, int offset, int value) noexcept {
    bpf_insn made{};
    made.code = static_cast<__u8>(code);
    made.dst_reg = destination & 0xFu;
    made.src_reg = source & 0xFu;
    made.off = static_cast<__s16>(offset);
    made.imm = value;
    return made;
}
// Op codes whose bits are spelled here: BPF_ADD, BPF_K, BPF_LD and BPF_IMM are 0, each in a field of its own, and put together by name they read as if one of
// them were written twice. Class in bits 0 to 2, source in bit 3, operation in bits 4 to 7; of loads size and mode in bits 3 to 7.
constexpr unsigned add_constant = 0x07;   // BPF_ALU64, BPF_ADD, BPF_K
constexpr unsigned load_constant = 0x18;  // BPF_LD, BPF_IMM, BPF_DW: of 64 bits, in two steps
static_assert(add_constant == BPF_ALU64 && load_constant == BPF_DW);

constexpr bpf_insn copy(unsigned to, unsigned from) noexcept { return step(BPF_ALU64 | BPF_MOV | BPF_X, to, from, 0, 0); }
constexpr bpf_insn set(unsigned to, int value) noexcept { return step(BPF_ALU64 | BPF_MOV | BPF_K, to, 0, 0, value); }
constexpr bpf_insn add(unsigned to, int value) noexcept { return step(add_constant, to, 0, 0, value); }
constexpr bpf_insn load(unsigned size, unsigned to, unsigned at, std::size_t offset) noexcept {
    return step(BPF_LDX | BPF_MEM | size, to, at, static_cast<int>(offset), 0);
}
constexpr bpf_insn call(int function) noexcept { return step(BPF_JMP | BPF_CALL, 0, 0, 0, function); }
/// Skips so many instructions where the first register is above the second one.
constexpr bpf_insn skip_if_above(unsigned first, unsigned second, int count) noexcept {
    return step(BPF_JMP | BPF_JGT | BPF_X, first, second, count, 0);
}
constexpr bpf_insn skip_unless(unsigned is, int value, int count) noexcept { return step(BPF_JMP | BPF_JNE | BPF_K, is, 0, count, value); }
constexpr bpf_insn leave() noexcept { return step(BPF_JMP | BPF_EXIT, 0, 0, 0, 0); }

constexpr int header = 14, type_at = 12, stamp_size = 8;

auto program_for(int sockets) noexcept {
    return std::array{
        copy(6, 1),
        load(BPF_W, 2, 1, offsetof(xdp_md, data)),
        load(BPF_W, 3, 1, offsetof(xdp_md, data_end)),
        copy(4, 2),
        add(4, header),
        skip_if_above(4, 3, 20),  // too short: pass
        load(BPF_H, 5, 2, type_at),
        skip_unless(5, htons(ethertype), 18),  // not ours: pass
        // CLOCK_MONOTONIC, as machine time is.
        call(BPF_FUNC_ktime_get_ns),
        copy(7, 0),
        // Room before the frame; a driver without it leaves the frame undated.
        copy(1, 6),
        set(2, -stamp_size),
        call(BPF_FUNC_xdp_adjust_meta),
        skip_unless(0, 0, 6),
        load(BPF_W, 2, 6, offsetof(xdp_md, data_meta)),
        load(BPF_W, 3, 6, offsetof(xdp_md, data)),
        copy(4, 2),
        add(4, stamp_size),
        skip_if_above(4, 3, 1),
        step(BPF_STX | BPF_MEM | BPF_DW, 2, 7, 0, 0),
        // A queue without a socket: on to the stack (r3), where a packet socket hears it.
        step(load_constant, 1, BPF_PSEUDO_MAP_FD, 0, sockets),
        step(0, 0, 0, 0, 0),
        load(BPF_W, 2, 6, offsetof(xdp_md, rx_queue_index)),
        set(3, XDP_PASS),
        call(BPF_FUNC_redirect_map),
        leave(),
        // pass:
        set(0, XDP_PASS),
        leave(),
    };
}

/// A union: {} would clear its first member only, and the kernel wants zeros.
bpf_attr nothing_asked() noexcept {
    bpf_attr attributes;
    std::memset(&attributes, 0, sizeof attributes);
    return attributes;
}

int bpf(bpf_cmd command, bpf_attr& attributes) noexcept {
    return static_cast<int>(::syscall(SYS_bpf, command, &attributes, sizeof attributes));
}

template <std::size_t size>
void name(char (&to)[size]) noexcept {
    std::memcpy(to, "taktwerk", 9);
}

__u64 address_of(const void* memory) noexcept { return reinterpret_cast<std::uintptr_t>(memory); }

}  // namespace

Error no_xdp(std::string_view interface, std::string_view tried, int number) {
    std::string why = std::strerror(number), remedy = "write `transport: packet` into the machine file's `bus`";
    if (number == EPERM || number == EACCES) {
        why = "the process lacks a privilege";
        remedy = "give it CAP_NET_RAW, CAP_NET_ADMIN and CAP_BPF (docs/bus.md), or " + remedy;
    } else if (number == ENOSYS || number == EAFNOSUPPORT) {
        why = "this kernel was built without it";
    } else if (number == ENOMEM || number == ENOBUFS) {
        remedy = "let it lock more memory (LimitMEMLOCK=infinity), or " + remedy;
    }
    return interface_error("transport.no_xdp", interface, fmt::format("no AF_XDP: {} failed: {}", tried, why), std::move(remedy));
}

Result<XdpProgram> XdpProgram::load(std::string_view interface) {
    auto map = nothing_asked();
    map.map_type = BPF_MAP_TYPE_XSKMAP;
    map.key_size = map.value_size = sizeof(__u32);
    map.max_entries = queues;
    name(map.map_name);
    Descriptor sockets{bpf(BPF_MAP_CREATE, map)};
    if (sockets.get() < 0) return no_xdp(interface, "making the map of sockets", errno == EINVAL ? ENOSYS : errno);  // it knows no such map

    const auto code = program_for(sockets.get());
    auto loading = nothing_asked();
    loading.prog_type = BPF_PROG_TYPE_XDP;
    loading.expected_attach_type = BPF_XDP;
    loading.insns = address_of(code.data());
    loading.insn_cnt = static_cast<__u32>(code.size());
    loading.license = address_of("Apache-2.0");
    name(loading.prog_name);
    Descriptor program{bpf(BPF_PROG_LOAD, loading)};
    if (program.get() < 0) return no_xdp(interface, "loading the program that picks EtherCAT", errno);
    return XdpProgram{std::string{interface}, std::move(sockets), std::move(program)};
}

bool XdpProgram::hand_to(int socket) noexcept {
    const __u32 queue = 0, value = static_cast<__u32>(socket);
    auto entry = nothing_asked();
    entry.map_fd = static_cast<__u32>(sockets_.get());
    entry.key = address_of(&queue);
    entry.value = address_of(&value);
    return bpf(BPF_MAP_UPDATE_ELEM, entry) == 0;
}

Result<XdpProgram::Place> XdpProgram::attach(unsigned index, Places places) {
    const auto linked = [&](__u32 flags) {
        auto link = nothing_asked();
        link.link_create.prog_fd = static_cast<__u32>(program_.get());
        link.link_create.target_ifindex = index;
        link.link_create.attach_type = BPF_XDP;
        link.link_create.flags = flags;
        link_ = Descriptor{bpf(BPF_LINK_CREATE, link)};
        return link_.get() >= 0;
    };
    const auto taken = [](int number) { return number == EBUSY || number == EEXIST; };
    int number = EOPNOTSUPP;
    if (places != Places::stack) {
        if (linked(XDP_FLAGS_DRV_MODE)) return Place::driver;
        number = errno;
    }
    if (places != Places::driver && !taken(number)) {
        if (linked(XDP_FLAGS_SKB_MODE)) return Place::stack;
        number = errno;
    }
    if (taken(number))
        return interface_error(
            "transport.xdp_taken", interface_, "no AF_XDP: another XDP program is on it",
            fmt::format("`ip link show dev {0}` names it; end whoever put it there, or `ip link set dev {0} xdp off`; or write "
                        "`transport: packet` into the machine file's `bus`",
                        interface_));
    return no_xdp(interface_,
                  places == Places::driver ? "putting the program into the driver" : "putting the program before the stack (Linux 5.9 can)",
                  number);
}

}  // namespace taktwerk::ecat
