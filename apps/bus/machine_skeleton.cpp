#include "apps/bus/machine_skeleton.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/one_line.hpp"

namespace taktwerk::apps {

namespace {

using Kind = RecognisedSlave::Kind;
using runtime::IoDirection;

constexpr std::size_t longest_name = 40;
constexpr std::size_t most_points = 64;  // of one slave: what has more is named by hand

std::string slave_name(const RecognisedSlave& slave, std::size_t position) {
    auto name = slave.type;
    std::replace(name.begin(), name.end(), '-', '_');
    return fmt::format("{}_{}", name.substr(0, longest_name - 6), position);
}

/// Is the channel's object exchanged as the device comes from the factory?
bool is_exchanged(const ecat::DeviceDescription& device, const config::DeviceChannel& channel) {
    const bool rx = channel.direction == IoDirection::output;
    const auto& assigned = rx ? device.rx_assigned : device.tx_assigned;
    const auto& pdos = rx ? device.rx_pdos : device.tx_pdos;
    return std::any_of(pdos.begin(), pdos.end(), [&](const ecat::PdoDescription& pdo) {
        return std::find(assigned.begin(), assigned.end(), pdo.index) != assigned.end() &&
               std::any_of(pdo.entries.begin(), pdo.entries.end(),
                           [&](const ecat::PdoEntry& entry) { return entry.index == channel.index && entry.sub == channel.sub; });
    });
}

std::string slaves_text(const ecat::Survey& survey, const std::vector<RecognisedSlave>& slaves, bool complete) {
    std::string out;
    for (std::size_t n = 0; n < slaves.size(); ++n) {
        const auto& slave = slaves[n];
        const auto& id = survey.slaves[n].found.identity;
        if (!slave.remark.empty()) out += fmt::format("    # {}\n", on_one_line(slave.remark));
        if (slave.kind == Kind::unknown) {
            out += fmt::format("    # position {}: vendor {:08X}h product {:08X}h revision {:08X}h: no file describes it\n", n, id.vendor,
                               id.product, id.revision);
            continue;
        }
        out += fmt::format("    - {{ name: {}, {}: {}", slave_name(slave, n), slave.kind == Kind::drive ? "profile" : "device", slave.type);
        if (!complete) out += fmt::format(", position: {}", n);
        out += " }\n";
    }
    return out;
}

/// Does the axis of an encoder use it? Then it is nobody else's.
bool is_of_an_encoder(const config::LoadedDevice& device, const config::DeviceChannel& channel) {
    const auto arms = [&](const axes::EncoderLatch& latch) {
        return latch.there() && latch.arm.index == channel.index && latch.arm.sub == channel.sub;
    };
    return channel.direction == IoDirection::output &&
           std::any_of(device.encoders.begin(), device.encoders.end(), [&](const axes::EncoderChannel& encoder) {
               return arms(encoder.index) || arms(encoder.rising) || arms(encoder.falling);
           });
}

std::string points_text(const std::vector<RecognisedSlave>& slaves, IoDirection direction) {
    std::string out;
    std::set<std::string> taken;
    for (std::size_t n = 0; n < slaves.size(); ++n) {
        const auto* device = slaves[n].device;
        if (slaves[n].kind != Kind::device || device == nullptr) continue;
        std::size_t count = 0;
        for (const auto& channel : device->channels) {
            if (channel.direction != direction || !is_exchanged(*device->device, channel) || is_of_an_encoder(*device, channel)) continue;
            const auto of_slave = slave_name(slaves[n], n);
            if (++count > most_points) {
                out += fmt::format("    # {}: has more channels, see its device file\n", of_slave);
                break;
            }
            auto name = fmt::format("{}_{}", of_slave, channel.name);
            if (name.size() > longest_name || !taken.insert(name).second)
                name = fmt::format("{}_{}{}", of_slave, direction == IoDirection::input ? "in" : "out", count);
            taken.insert(name);
            out += fmt::format("    {}: {{ slave: {}, channel: {} }}\n", name, of_slave, channel.name);
        }
    }
    return out;
}

constexpr std::string_view drive_guesses =
    "    unit: mm                                                                      # FILL IN: mm, deg, ...\n"
    "    gearing: { counts_per_revolution: 131072, feed: 10 mm }                       # FILL IN: encoder, and way of one turn\n"
    "    limits: { velocity: 10 mm/s, acceleration: 100 mm/s2, jerk: 1000 mm/s3 }      # slow on purpose; and position: [a, b]\n"
    "    following_error: { window: 1 mm }                                             # FILL IN\n"
    "    homing: { kind: set_here }                                                    # FILL IN: docs/motion\n";
constexpr std::string_view encoder_guesses =
    "    encoder: true                                                                 # it is read, and moves nothing\n"
    "    unit: mm                                                                      # FILL IN: mm, deg, ...\n"
    "    gearing: { counts_per_revolution: 4096, feed: 10 mm }                         # FILL IN: four edges a line; way of one turn\n"
    "    limits: { velocity: 1000 mm/s, acceleration: 10000 mm/s2, jerk: 100000 mm/s3 }      # velocity: twice of it is no motion\n";

/// Drives first, as they stand on the bus, then encoders.
std::string axes_text(const std::vector<RecognisedSlave>& slaves) {
    std::string out;
    unsigned number = 0;
    const auto add = [&](std::size_t n, std::size_t of_slave, std::size_t which, std::string_view guesses) {
        out += fmt::format("  axis{}:\n    slave: {}\n", ++number, slave_name(slaves[n], n));
        if (of_slave > 1) out += fmt::format("    axis: {}\n", which);
        out += guesses;
    };
    for (std::size_t n = 0; n < slaves.size(); ++n)
        if (slaves[n].kind == Kind::drive)
            for (std::size_t axis = 1; axis <= slaves[n].axes; ++axis) add(n, slaves[n].axes, axis, drive_guesses);
    for (std::size_t n = 0; n < slaves.size(); ++n) {
        if (slaves[n].kind != Kind::device || slaves[n].device == nullptr) continue;
        const auto encoders = slaves[n].device->encoders.size();
        for (std::size_t encoder = 1; encoder <= encoders; ++encoder) add(n, encoders, encoder, encoder_guesses);
    }
    return out;
}

}  // namespace

std::string machine_skeleton(const std::string& name, const std::string& interfaces, const ecat::Survey& survey,
                             const std::vector<RecognisedSlave>& slaves) {
    const bool complete = std::none_of(slaves.begin(), slaves.end(), [](const RecognisedSlave& one) { return one.kind == Kind::unknown; });
    auto out = fmt::format(
        "# Made by `taktwerk bus init` of what is on the bus. Units, limits and homing of axes are guesses: fill them in before a drive is "
        "enabled.\n"
        "version: 1\nname: {}\ncycle: 1 ms\nbus:\n{}",
        name, interfaces);
    if (!complete) out += "  extra_slaves: ignore     # those that no file describes stay in INIT\n";
    out += "  slaves:\n" + slaves_text(survey, slaves, complete);
    const auto inputs = points_text(slaves, IoDirection::input), outputs = points_text(slaves, IoDirection::output);
    if (!inputs.empty() || !outputs.empty()) out += "io:\n";
    if (!inputs.empty()) out += "  inputs:\n" + inputs;
    if (!outputs.empty()) out += "  outputs:\n" + outputs;
    if (const auto axes = axes_text(slaves); !axes.empty()) out += "axes:\n" + axes;
    return out;
}

}  // namespace taktwerk::apps
