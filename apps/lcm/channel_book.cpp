#include "apps/lcm/channel_book.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "hmi_bridge/lcm_types/message_reader.hpp"

namespace taktwerk::apps {
namespace {

constexpr std::int64_t window = 1'000'000;
constexpr std::array<std::string_view, 9> state_endings{"HEARTBEAT", "MACHINE_STATE",  "AXIS_STATE",       "AXIS_HOLDER", "COMMAND_EVENT",
                                                        "IO_STATE",  "PROGRAM_VALUES", "CYCLE_STATISTICS", "ALARM_LIST"};
constexpr std::string_view ours = "TAKTWERK_";

}  // namespace

std::string machine_prefix(std::string_view channel) {
    if (!channel.starts_with(ours)) return {};
    for (const auto ending : state_endings)
        if (channel.size() > ours.size() + ending.size() + 1 && channel.ends_with(ending) &&
            channel[channel.size() - ending.size() - 1] == '_')
            return std::string(channel.substr(0, channel.size() - ending.size()));
    return {};
}

void ChannelBook::note(std::string_view name, std::span<const std::byte> message, std::int64_t utime) {
    ++messages_;
    const auto fingerprint = hmi::fingerprint_of(message);
    const auto* type = fingerprint ? catalog_.find(*fingerprint) : nullptr;

    // First fields of every state message: utime, seq.
    if (const auto prefix = machine_prefix(name);
        !prefix.empty() && type != nullptr && message.size() >= 24 && sequences_.size() < most_channels) {
        const auto seq = static_cast<std::int64_t>(*hmi::fingerprint_of(message.subspan(16)));
        auto& sequence = sequences_[prefix];
        if (sequence.messages > 0 && seq > sequence.last + 1) sequence.lost += static_cast<std::uint64_t>(seq - sequence.last - 1);
        if (sequence.messages > 0 && seq <= sequence.last) ++sequence.restarts;
        sequence.last = seq;
        ++sequence.messages;
    }

    auto found = channels_.find(name);
    if (found == channels_.end()) {
        if (channels_.size() >= most_channels) {
            ++unlisted_;
            return;
        }
        found = channels_.emplace(std::string(name), Channel{}).first;
        found->second.row.channel = found->first;
        found->second.row.first_utime = found->second.window_utime = utime;
    }
    auto& channel = found->second;
    if (const auto in_window = utime - channel.window_utime; in_window >= window) {
        channel.window_rate = static_cast<double>(channel.window_messages) * 1e6 / static_cast<double>(in_window);
        channel.window_utime = utime;
        channel.window_messages = 0;
    }
    ++channel.window_messages;
    auto& row = channel.row;
    row.type = type != nullptr ? type->name : fingerprint ? fmt::format("0x{:016x}", *fingerprint) : "none";
    ++row.messages;
    row.bytes += message.size();
    row.last_size = message.size();
    row.last_utime = utime;
}

std::vector<ChannelBook::Row> ChannelBook::rows(std::int64_t utime) const {
    std::vector<Row> out;
    for (const auto& [name, channel] : channels_) {
        out.push_back(channel.row);
        const auto since = static_cast<double>(utime - channel.window_utime) / 1e6;
        const bool silent = since >= 2;  // nothing has closed its window
        // Of a first window: its gaps, of which there is one less than messages; but what came in one burst is no rate.
        if (channel.window_rate < 0 && !silent) {
            const auto gaps = static_cast<double>(channel.row.last_utime - channel.row.first_utime);
            const auto messages = static_cast<double>(channel.row.messages);
            const double most = since > 0 ? messages / since : 0;
            out.back().rate = channel.row.messages < 2 || gaps <= 0 ? 0 : std::min((messages - 1) * 1e6 / gaps, most);
        } else out.back().rate = silent ? static_cast<double>(channel.window_messages) / since : channel.window_rate;
    }
    return out;
}

std::vector<ChannelBook::Machine> ChannelBook::machines() const {
    std::vector<Machine> out;
    for (const auto& [prefix, sequence] : sequences_) out.push_back({prefix, sequence.messages, sequence.lost, sequence.restarts});
    return out;
}

std::uint64_t ChannelBook::lost() const {
    std::uint64_t out = 0;
    for (const auto& [prefix, sequence] : sequences_) out += sequence.lost;
    return out;
}

}  // namespace taktwerk::apps
