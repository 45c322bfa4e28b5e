#include "ecat/layout/slave_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace taktwerk::ecat {

namespace {

Error plan_error(const char* code, const PlanSlave& slave, std::string what, std::string remedy) {
    return Error{std::string{"bus.plan."} + code, slave.subject, std::move(what), std::move(remedy)};
}

std::uint8_t usual_control(SmUse use) { return use == SmUse::outputs ? SyncManager::usual_outputs : SyncManager::usual_inputs; }

/// The PDOs of one direction, handed out to its sync managers one after the other.
class PdoQueue {
public:
    PdoQueue(const PlanSlave& slave, SmUse use, const std::vector<PdoDescription>& pdos) : taken_(pdos.size(), false), pdos_(pdos) {
        for (std::size_t n = slave.sync_managers.size(); n-- > 0;)
            if (slave.sync_managers[n].use == use) first_ = static_cast<std::uint8_t>(n);
    }

    /// PDOs that name this manager; without a name all belong to the first one.
    std::vector<const PdoDescription*> assigned_to(std::uint8_t manager) {
        std::vector<const PdoDescription*> mine;
        for (std::size_t i = 0; i < pdos_.size(); ++i)
            if (!taken_[i] && pdos_[i].sync_manager.value_or(first_) == manager) {
                taken_[i] = true;
                mine.push_back(&pdos_[i]);
            }
        return mine;
    }

    /// PDOs that name this manager, and those without a name for as long as they fit.
    std::vector<const PdoDescription*> filling(std::uint8_t manager, std::size_t bits) {
        std::vector<const PdoDescription*> mine;
        for (std::size_t i = 0; i < pdos_.size(); ++i) {
            if (taken_[i] || pdos_[i].sync_manager.value_or(manager) != manager) continue;
            const std::size_t wanted = mapped_bits({&pdos_[i], 1});
            if (wanted > bits) break;
            bits -= wanted;
            taken_[i] = true;
            mine.push_back(&pdos_[i]);
        }
        return mine;
    }

    [[nodiscard]] const PdoDescription* left_over() const {
        for (std::size_t i = 0; i < pdos_.size(); ++i)
            if (!taken_[i]) return &pdos_[i];
        return nullptr;
    }

private:
    std::vector<bool> taken_;
    const std::vector<PdoDescription>& pdos_;
    std::uint8_t first_ = 0;
};

/// Adjacent memory takes one FMMU.
void append_run(std::vector<MappedHalf::Run>& runs, std::uint16_t start, std::uint16_t bytes) {
    if (!runs.empty() && runs.back().start + runs.back().bytes == start)
        runs.back().bytes = static_cast<std::uint16_t>(runs.back().bytes + bytes);
    else runs.push_back({start, bytes});
}

Result<MappedHalf> map_half(const PlanSlave& slave, SmUse use, const std::vector<PdoDescription>& pdos) {
    MappedHalf half;
    const char* direction = use == SmUse::outputs ? "outputs" : "inputs";
    PdoQueue queue{slave, use, pdos};
    for (std::size_t n = 0; n < slave.sync_managers.size(); ++n) {
        const auto& described = slave.sync_managers[n];
        if (described.use != use) continue;
        const auto number = static_cast<std::uint8_t>(n);
        const std::uint32_t first_bit = half.bytes * 8;
        std::uint32_t bit = first_bit;
        for (const auto* pdo : slave.coe ? queue.assigned_to(number) : queue.filling(number, described.size * std::size_t{8}))
            for (const auto& entry : pdo->entries) {
                if (entry.index != 0) half.entries.push_back({entry.index, entry.sub, entry.bits, bit});
                bit += entry.bits;
            }
        // A terminal wants the length its EEPROM says, whatever part of it is mapped.
        const std::uint32_t bytes = slave.coe ? (bit - first_bit + 7) / 8 : described.size;
        if (bytes == 0) continue;
        if (bytes > 0xFFFF)
            return plan_error("too_large", slave, fmt::format("its {} are {} bytes, a sync manager has 65535", direction, bytes),
                              "map fewer objects");
        SyncManager sm;
        sm.start = described.start;
        sm.length = static_cast<std::uint16_t>(bytes);
        sm.control = described.control != 0 ? described.control : usual_control(use);
        sm.activate = SyncManager::enable;
        half.sync_managers.push_back({number, sm});
        append_run(half.runs, sm.start, sm.length);
        half.bytes += bytes;
    }
    if (const auto* pdo = queue.left_over())
        return plan_error("no_sync_manager", slave,
                          fmt::format("PDO {:04X}h finds no room in a sync manager for {}", pdo->index, direction),
                          "check sync managers and PDOs in its profile");
    return half;
}

/// Buffered sync managers of slaves with an application keep three buffers: 3 * length bytes from start belong to them.
std::optional<Error> overlapping_buffers(const PlanSlave& slave, const SlaveMapping& mapping) {
    struct Area {
        unsigned sm;
        std::uint32_t start, end;
    };
    std::vector<Area> areas;
    const std::uint32_t buffers = slave.coe ? 3 : 1;
    for (const auto* half : {&mapping.outputs, &mapping.inputs})
        for (const auto& sm : half->sync_managers)
            areas.push_back({sm.number, sm.registers.start, sm.registers.start + buffers * sm.registers.length});
    for (std::size_t n = 0; n < slave.sync_managers.size(); ++n) {
        const auto& sm = slave.sync_managers[n];
        if (sm.use == SmUse::mailbox_out || sm.use == SmUse::mailbox_in)
            areas.push_back({static_cast<unsigned>(n), sm.start, std::uint32_t{sm.start} + sm.size});
    }
    std::sort(areas.begin(), areas.end(), [](const Area& a, const Area& b) { return a.start < b.start; });
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (areas[i].end > 0x10000)
            return plan_error("too_large", slave,
                              fmt::format("the buffers of SM{} ({:04X}h..{:X}h) reach beyond the controller's memory", areas[i].sm,
                                          areas[i].start, areas[i].end - 1),
                              "map fewer objects");
        if (i == 0 || areas[i - 1].end <= areas[i].start) continue;
        return plan_error("overlap", slave,
                          fmt::format("the buffers of SM{} ({:04X}h..{:04X}h) reach into SM{} at {:04X}h", areas[i - 1].sm,
                                      areas[i - 1].start, areas[i - 1].end - 1, areas[i].sm, areas[i].start),
                          "map fewer objects, or correct the start addresses in its profile");
    }
    return std::nullopt;
}

std::optional<Error> limits_exceeded(const PlanSlave& slave, const SlaveMapping& mapping) {
    const std::size_t fmmus = mapping.outputs.runs.size() + mapping.inputs.runs.size();
    if (fmmus > slave.fmmus)
        return plan_error("too_many_fmmus", slave,
                          fmt::format("its process data needs {} FMMUs, its controller has {}", fmmus, slave.fmmus),
                          "use fewer sync managers in its profile");
    if (slave.sync_managers.size() > slave.sync_manager_count)
        return plan_error(
            "too_many_sync_managers", slave,
            fmt::format("its profile has {} sync managers, its controller {}", slave.sync_managers.size(), slave.sync_manager_count),
            "correct its profile");
    return std::nullopt;
}

}  // namespace

std::size_t mapped_bits(std::span<const PdoDescription> pdos) noexcept {
    std::size_t bits = 0;
    for (const auto& pdo : pdos)
        for (const auto& entry : pdo.entries) bits += entry.bits;
    return bits;
}

Result<SlaveMapping> map_slave(const PlanSlave& slave) {
    auto outputs = map_half(slave, SmUse::outputs, slave.rx);
    if (!outputs) return outputs.error();
    auto inputs = map_half(slave, SmUse::inputs, slave.tx);
    if (!inputs) return inputs.error();
    SlaveMapping mapping{std::move(*outputs), std::move(*inputs)};
    if (auto error = limits_exceeded(slave, mapping)) return *error;
    if (auto error = overlapping_buffers(slave, mapping)) return *error;
    return mapping;
}

}  // namespace taktwerk::ecat
