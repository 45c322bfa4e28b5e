#include "ecat/layout/process_data_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/layout/frame_schedule.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint32_t mailbox_gap = 4;           // bytes between process data and mailbox bits
constexpr std::uint16_t sm_status_offset = 5;      // of a sync manager's registers
constexpr std::uint8_t mailbox_full_position = 3;  // of its status

/// Bytes from `begin` up to `end` of an address space.
struct Window {
    std::uint32_t begin = 0, end = 0;
    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
    [[nodiscard]] Window overlap(Window other) const noexcept {
        const std::uint32_t from = std::max(begin, other.begin), to = std::min(end, other.end);
        return from < to ? Window{from, to} : Window{from, from};
    }
};

class Planner {
public:
    Planner(std::span<const PlanSlave> slaves, std::span<const SyncUnitConfig> units) : slaves_(slaves), configured_(units) {}

    Result<ProcessDataPlan> run() {
        for (const auto& slave : slaves_) {
            auto mapping = map_slave(slave);
            if (!mapping) return mapping.error();
            mappings_.push_back(std::move(*mapping));
        }
        plan_.slaves.resize(slaves_.size());
        out_at_.resize(slaves_.size());
        in_at_.resize(slaves_.size());
        for (std::size_t s = 0; s < slaves_.size(); ++s)
            for (const auto* half : {&mappings_[s].outputs, &mappings_[s].inputs})
                plan_.slaves[s].sync_managers.insert(plan_.slaves[s].sync_managers.end(), half->sync_managers.begin(),
                                                     half->sync_managers.end());
        // The bits' size decides how much room the first frame has; their place comes last.
        choose_mailbox_bits();
        make_units();
        for (std::size_t u = 0; u < plan_.units.size(); ++u) lay_out(u);
        place_mailbox_bits();
        stagger(plan_);
        const auto frames = frames_at_most(plan_);
        if (!frames)
            return Error{"bus.plan.too_many_frames", "bus",
                         fmt::format("its process data needs more than {} frames a cycle", max_cyclic_frames), "use two buses"};
        plan_.frames = *frames;
        plan_.output_bytes = image_out_;
        plan_.input_bytes = image_in_;
        return std::move(plan_);
    }

private:
    void make_units() {
        for (std::size_t s = 0; s < slaves_.size(); ++s) {
            if (mappings_[s].bytes() == 0) continue;
            const auto& name = slaves_[s].sync_unit;
            auto unit =
                std::find_if(plan_.units.begin(), plan_.units.end(), [&](const UnitPlan& u) { return !name.empty() && u.name == name; });
            if (unit == plan_.units.end()) {
                UnitPlan fresh;
                fresh.name = name;
                for (const auto& c : configured_)
                    if (!name.empty() && c.name == name && c.divisor > 0) fresh.divisor = c.divisor;
                unit = plan_.units.insert(plan_.units.end(), std::move(fresh));
            }
            unit->slaves.push_back(s);
            plan_.slaves[s].unit = static_cast<std::size_t>(unit - plan_.units.begin());
        }
    }

    [[nodiscard]] bool reads_and_writes(const UnitPlan& unit) const {
        return std::all_of(unit.slaves.begin(), unit.slaves.end(), [&](std::size_t s) { return slaves_[s].lrw; });
    }

    /// Blocks of whole slaves that fit a datagram also in the first frame; a slave that does not is a block of its own.
    void lay_out(std::size_t u) {
        auto& unit = plan_.units[u];
        const bool lrw = reads_and_writes(unit);
        const std::size_t room = std::min(FramePacker::room_in_first(plan_.mailbox), max_datagram_data);
        unit.first = plan_.datagrams.size();
        std::vector<std::size_t> block;
        std::size_t out = 0, in = 0;
        for (const std::size_t s : unit.slaves) {
            const std::size_t more_out = mappings_[s].outputs.bytes, more_in = mappings_[s].inputs.bytes;
            const std::size_t needed = lrw ? out + in + more_out + more_in : std::max(out + more_out, in + more_in);
            if (!block.empty() && needed > room) {
                lay_out_block(u, block, lrw);
                block.clear();
                out = in = 0;
            }
            block.push_back(s);
            out += more_out;
            in += more_in;
        }
        lay_out_block(u, block, lrw);
        unit.count = plan_.datagrams.size() - unit.first;
    }

    void lay_out_block(std::size_t u, const std::vector<std::size_t>& block, bool lrw) {
        const Window all_out = place(block, &SlaveMapping::outputs, &SlavePlan::outputs, &SlavePlan::mapped_outputs, image_out_, out_at_);
        const Window all_in = place(block, &SlaveMapping::inputs, &SlavePlan::inputs, &SlavePlan::mapped_inputs, image_in_, in_at_);
        image_out_ += all_out.size();
        image_in_ += all_in.size();
        if (lrw) cut(u, block, Command::LRW, {all_out.begin, all_in.end}, all_out, all_in);
        else {
            cut(u, block, Command::LWR, all_out, all_out, all_in);
            cut(u, block, Command::LRD, all_in, all_out, all_in);
        }
    }

    /// One direction of the block's slaves, one behind the other: logical addresses, FMMUs, image.
    Window place(const std::vector<std::size_t>& block, MappedHalf SlaveMapping::*half, ImageRange SlavePlan::*range,
                 std::vector<MappedEntry> SlavePlan::*mapped, std::uint32_t image, std::vector<Window>& where) {
        const bool outputs = half == &SlaveMapping::outputs;
        const std::uint32_t begin = logical_;
        for (const std::size_t s : block) {
            const auto& from = mappings_[s].*half;
            auto& slave = plan_.slaves[s];
            where[s] = {logical_, logical_ + from.bytes};
            slave.*range = {image + logical_ - begin, from.bytes};
            slave.*mapped = from.entries;
            for (auto& entry : slave.*mapped) entry.bit_offset += (slave.*range).offset * 8;
            for (const auto& run : from.runs) {
                Fmmu fmmu;
                fmmu.logical_start = logical_;
                fmmu.length = run.bytes;
                fmmu.physical_start = run.start;
                fmmu.write = outputs;
                fmmu.read = !outputs;
                fmmu.active = true;
                slave.fmmus.push_back(fmmu);
                logical_ += run.bytes;
            }
        }
        return {begin, logical_};
    }

    /// `range` in datagrams: one, unless it is a slave larger than a frame.
    void cut(std::size_t u, const std::vector<std::size_t>& block, Command command, Window range, Window all_out, Window all_in) {
        const bool writes = command != Command::LRD, reads = command != Command::LWR;
        const std::uint32_t image_out = image_out_ - all_out.size(), image_in = image_in_ - all_in.size();
        for (std::uint32_t at = range.begin; at < range.end; at += static_cast<std::uint32_t>(max_datagram_data)) {
            const Window window{at, std::min(range.end, at + static_cast<std::uint32_t>(max_datagram_data))};
            DatagramPlan datagram;
            datagram.command = command;
            datagram.logical = at;
            datagram.unit = u;
            datagram.continues = at != range.begin;
            const Window out = window.overlap(all_out), in = window.overlap(all_in);
            if (writes) datagram.outputs = {image_out + out.begin - all_out.begin, out.size()};
            if (reads) datagram.inputs = {image_in + in.begin - all_in.begin, in.size()};
            unsigned wkc = 0;
            for (const std::size_t s : block) {
                const bool written = writes && window.overlap(out_at_[s]).size() > 0;
                const bool read = reads && window.overlap(in_at_[s]).size() > 0;
                wkc += (written ? (command == Command::LRW ? 2u : 1u) : 0u) + (read ? 1u : 0u);
                if (written || read) datagram.slaves.push_back(s);
            }
            datagram.expected_wkc = static_cast<std::uint16_t>(wkc);
            plan_.datagrams.push_back(std::move(datagram));
        }
    }

    /// Bits of the controllers that map bits, then a byte for each of the others.
    void choose_mailbox_bits() {
        std::uint32_t bits = 0;
        const auto wants = [&](std::size_t s) {
            return slaves_[s].mailbox_in && mappings_[s].outputs.runs.size() + mappings_[s].inputs.runs.size() < slaves_[s].fmmus;
        };
        for (std::size_t s = 0; s < slaves_.size() && bits < MailboxStatusPlan::max_size * 8; ++s)
            if (wants(s) && slaves_[s].bitwise_fmmu) plan_.slaves[s].mailbox_bit = bits++;
        std::uint32_t byte = (bits + 7) / 8;
        for (std::size_t s = 0; s < slaves_.size() && byte < MailboxStatusPlan::max_size; ++s)
            if (wants(s) && !slaves_[s].bitwise_fmmu) plan_.slaves[s].mailbox_bit = byte++ * 8 + mailbox_full_position;
        plan_.mailbox.size = static_cast<std::uint16_t>(byte);
    }

    void place_mailbox_bits() {
        plan_.mailbox.logical = logical_ + mailbox_gap;
        for (std::size_t s = 0; s < slaves_.size(); ++s) {
            auto& slave = plan_.slaves[s];
            if (!slave.mailbox_bit) continue;
            Fmmu fmmu;
            fmmu.logical_start = plan_.mailbox.logical + *slave.mailbox_bit / 8;
            fmmu.length = 1;
            fmmu.physical_start = static_cast<std::uint16_t>(reg::sync_manager_at(*slaves_[s].mailbox_in) + sm_status_offset);
            if (slaves_[s].bitwise_fmmu) {
                fmmu.logical_start_bit = fmmu.logical_stop_bit = static_cast<std::uint8_t>(*slave.mailbox_bit % 8);
                fmmu.physical_start_bit = mailbox_full_position;
            }
            fmmu.read = true;
            fmmu.active = true;
            slave.fmmus.push_back(fmmu);
            ++plan_.mailbox.expected_wkc;
        }
    }

    std::span<const PlanSlave> slaves_;
    std::span<const SyncUnitConfig> configured_;
    std::vector<SlaveMapping> mappings_;
    std::vector<Window> out_at_, in_at_;  ///< logical, by slave
    ProcessDataPlan plan_;
    std::uint32_t logical_ = 0, image_out_ = 0, image_in_ = 0;
};

}  // namespace

Result<ProcessDataPlan> plan_process_data(std::span<const PlanSlave> slaves, std::span<const SyncUnitConfig> units) {
    return Planner{slaves, units}.run();
}

}  // namespace taktwerk::ecat
