#include "ecat/bringup/process_data_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/commands.hpp"

namespace taktwerk::ecat {

namespace {

/// FRMW of the system time and BRD of the AL status, in the first frame.
constexpr std::size_t clock_datagram = datagram_overhead + 8;
constexpr std::size_t state_datagram = datagram_overhead + 2;

/// One direction of one slave before it has its place: which sync manager carries how many bytes.
struct Half {
    struct Part {
        std::uint8_t sm = 0;
        std::uint16_t start = 0;
        std::uint16_t bytes = 0;
    };
    std::vector<Part> parts;
    std::vector<MappedEntry> entries;  // bit offsets from the half's start
    std::uint32_t bytes = 0;
};

std::uint8_t usual_control(SmUse use) { return use == SmUse::outputs ? SyncManager::usual_outputs : SyncManager::usual_inputs; }

Error plan_error(const char* code, const PlanSlave& slave, std::string what, std::string remedy) {
    return Error{std::string{"bus.plan."} + code, slave.subject, std::move(what), std::move(remedy)};
}

void append_entries(Half& half, const PdoDescription& pdo, std::uint32_t& bit) {
    for (const auto& entry : pdo.entries) {
        if (entry.index != 0) half.entries.push_back({entry.index, entry.sub, entry.bits, bit});
        bit += entry.bits;
    }
}

Result<Half> plan_half(const PlanSlave& slave, SmUse use, const std::vector<PdoDescription>& pdos) {
    Half half;
    const char* direction = use == SmUse::outputs ? "outputs" : "inputs";
    std::size_t next_pdo = 0;
    bool first = true;
    for (std::size_t n = 0; n < slave.sync_managers.size(); ++n) {
        const auto& sm = slave.sync_managers[n];
        if (sm.use != use) continue;
        std::uint32_t bit = half.bytes * 8;
        if (slave.coe) {
            if (first)
                for (; next_pdo < pdos.size(); ++next_pdo) append_entries(half, pdos[next_pdo], bit);
        } else if (pdos.empty()) {
            bit += sm.size * 8u;
        } else {
            const std::uint32_t end = bit + sm.size * 8u;
            while (next_pdo < pdos.size() && bit + mapped_bits({&pdos[next_pdo], 1}) <= end) append_entries(half, pdos[next_pdo++], bit);
        }
        first = false;
        // A terminal wants the length its EEPROM says, whatever part of it is mapped.
        const std::uint32_t bytes = slave.coe ? (bit + 7) / 8 - half.bytes : sm.size;
        if (bytes == 0) continue;
        if (bytes > max_datagram_data)
            return plan_error("too_large", slave,
                              fmt::format("its {} are {} bytes, a frame carries {}", direction, bytes, max_datagram_data),
                              "map fewer objects");
        half.parts.push_back({static_cast<std::uint8_t>(n), sm.start, static_cast<std::uint16_t>(bytes)});
        half.bytes += bytes;
    }
    if (next_pdo < pdos.size())
        return plan_error("no_sync_manager", slave,
                          fmt::format("PDO {:04X}h finds no room in a sync manager for {}", pdos[next_pdo].index, direction),
                          "check sync managers and PDOs in its profile");
    return half;
}

/// Buffered sync managers of slaves with an application keep three buffers: 3 * length bytes from start belong to them.
std::optional<Error> overlapping_buffers(const PlanSlave& slave, const std::vector<PlannedSyncManager>& process) {
    struct Area {
        unsigned sm;
        std::uint32_t start, end;
    };
    std::vector<Area> areas;
    const std::uint32_t buffers = slave.coe ? 3 : 1;
    for (const auto& sm : process) areas.push_back({sm.number, sm.registers.start, sm.registers.start + buffers * sm.registers.length});
    for (std::size_t n = 0; n < slave.sync_managers.size(); ++n) {
        const auto& sm = slave.sync_managers[n];
        if (sm.use == SmUse::mailbox_out || sm.use == SmUse::mailbox_in)
            areas.push_back({static_cast<unsigned>(n), sm.start, std::uint32_t{sm.start} + sm.size});
    }
    std::sort(areas.begin(), areas.end(), [](const Area& a, const Area& b) { return a.start < b.start; });
    for (std::size_t i = 1; i < areas.size(); ++i) {
        if (areas[i - 1].end <= areas[i].start) continue;
        return plan_error("overlap", slave,
                          fmt::format("the buffers of SM{} ({:04X}h..{:04X}h) reach into SM{} at {:04X}h", areas[i - 1].sm,
                                      areas[i - 1].start, areas[i - 1].end - 1, areas[i].sm, areas[i].start),
                          "map fewer objects, or correct the start addresses in its profile");
    }
    return std::nullopt;
}

Fmmu fmmu_for(std::uint32_t logical, std::uint16_t bytes, std::uint16_t physical, bool outputs) {
    Fmmu fmmu;
    fmmu.logical_start = logical;
    fmmu.length = bytes;
    fmmu.physical_start = physical;
    fmmu.write = outputs;
    fmmu.read = !outputs;
    fmmu.active = true;
    return fmmu;
}

struct Draft {
    Half out, in;
    [[nodiscard]] std::size_t bytes() const noexcept { return out.bytes + in.bytes; }
};

/// Slaves of one datagram, in configuration order.
std::vector<std::vector<std::size_t>> group_into_datagrams(std::span<const PlanSlave> slaves, const std::vector<Draft>& drafts) {
    std::vector<std::vector<std::size_t>> groups;
    std::vector<bool> taken(slaves.size(), false);
    const std::size_t room = frame_capacity - clock_datagram - state_datagram - datagram_overhead;
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        if (taken[i] || drafts[i].bytes() == 0) continue;
        std::vector<std::size_t> group;
        std::size_t bytes = 0;
        for (std::size_t k = i; k < slaves.size(); ++k) {
            const bool together = k == i || (!slaves[i].sync_unit.empty() && slaves[k].sync_unit == slaves[i].sync_unit);
            if (taken[k] || !together || drafts[k].bytes() == 0) continue;
            if (!group.empty() && bytes + drafts[k].bytes() > room) {
                groups.push_back(std::move(group));
                group.clear();
                bytes = 0;
            }
            group.push_back(k);
            bytes += drafts[k].bytes();
            taken[k] = true;
        }
        groups.push_back(std::move(group));
    }
    return groups;
}

std::optional<Error> limits_exceeded(const PlanSlave& slave, const Draft& draft) {
    if (!slave.lrw && draft.bytes() > 0)
        return plan_error("no_lrw", slave, "its controller does not execute LRW, and separate LRD and LWR are not supported yet",
                          "use another slave, or leave it without process data");
    const std::size_t fmmus = draft.out.parts.size() + draft.in.parts.size();
    if (fmmus > slave.fmmus)
        return plan_error("too_many_fmmus", slave,
                          fmt::format("its process data needs {} FMMUs, its controller has {}", fmmus, slave.fmmus),
                          "use fewer sync managers in its profile");
    if (slave.sync_managers.size() > slave.sync_manager_count)
        return plan_error(
            "too_many_sync_managers", slave,
            fmt::format("its profile has {} sync managers, its controller {}", slave.sync_managers.size(), slave.sync_manager_count),
            "correct its profile");
    const std::size_t room = frame_capacity - clock_datagram - state_datagram - datagram_overhead;
    if (draft.bytes() > room)
        return plan_error("too_large", slave, fmt::format("its process data is {} bytes, a frame carries {}", draft.bytes(), room),
                          "map fewer objects");
    return std::nullopt;
}

}  // namespace

std::size_t mapped_bits(std::span<const PdoDescription> pdos) noexcept {
    std::size_t bits = 0;
    for (const auto& pdo : pdos)
        for (const auto& entry : pdo.entries) bits += entry.bits;
    return bits;
}

Result<ProcessDataPlan> plan_process_data(std::span<const PlanSlave> slaves) {
    ProcessDataPlan plan;
    std::vector<Draft> drafts;
    for (const auto& slave : slaves) {
        auto out = plan_half(slave, SmUse::outputs, slave.rx);
        if (!out) return out.error();
        auto in = plan_half(slave, SmUse::inputs, slave.tx);
        if (!in) return in.error();
        Draft draft{std::move(*out), std::move(*in)};
        if (auto error = limits_exceeded(slave, draft)) return *error;

        SlavePlan planned;
        const auto add = [&](const Half& half, SmUse use) {
            for (const auto& part : half.parts) {
                SyncManager sm;
                sm.start = part.start;
                sm.length = part.bytes;
                sm.control = slave.sync_managers[part.sm].control != 0 ? slave.sync_managers[part.sm].control : usual_control(use);
                sm.activate = SyncManager::enable;
                planned.sync_managers.push_back({part.sm, sm});
            }
        };
        add(draft.out, SmUse::outputs);
        add(draft.in, SmUse::inputs);
        if (auto error = overlapping_buffers(slave, planned.sync_managers)) return *error;
        plan.slaves.push_back(std::move(planned));
        drafts.push_back(std::move(draft));
    }

    std::uint32_t logical = 0, out_at = 0, in_at = 0;
    std::size_t frame = 0, room = frame_capacity - clock_datagram - state_datagram;
    for (auto& group : group_into_datagrams(slaves, drafts)) {
        DatagramPlan datagram;
        datagram.logical = logical;
        datagram.outputs.offset = out_at;
        datagram.inputs.offset = in_at;
        for (const std::size_t s : group) {
            datagram.outputs.size += drafts[s].out.bytes;
            datagram.inputs.size += drafts[s].in.bytes;
            datagram.expected_wkc =
                static_cast<std::uint16_t>(datagram.expected_wkc + (drafts[s].out.bytes > 0 ? 2 : 0) + (drafts[s].in.bytes > 0 ? 1 : 0));
        }
        if (datagram.size() + datagram_overhead > room) {
            ++frame;
            room = frame_capacity;
        }
        room -= datagram.size() + datagram_overhead;
        datagram.frame = frame;

        std::uint32_t logical_in = logical + datagram.outputs.size;
        for (const std::size_t s : group) {
            auto& planned = plan.slaves[s];
            planned.datagram = plan.datagrams.size();
            const auto place = [&](const Half& half, ImageRange& range, std::vector<MappedEntry>& mapped, std::uint32_t& image_at,
                                   std::uint32_t& logical_at, bool outputs) {
                range = {image_at, half.bytes};
                mapped = half.entries;
                for (auto& entry : mapped) entry.bit_offset += image_at * 8;
                for (const auto& part : half.parts) {
                    planned.fmmus.push_back(fmmu_for(logical_at, part.bytes, part.start, outputs));
                    logical_at += part.bytes;
                }
                image_at += half.bytes;
            };
            place(drafts[s].out, planned.outputs, planned.mapped_outputs, out_at, logical, true);
            place(drafts[s].in, planned.inputs, planned.mapped_inputs, in_at, logical_in, false);
        }
        logical = logical_in;
        datagram.slaves = std::move(group);
        plan.datagrams.push_back(std::move(datagram));
    }
    plan.frames = frame + 1;
    plan.output_bytes = out_at;
    plan.input_bytes = in_at;
    return plan;
}

}  // namespace taktwerk::ecat
