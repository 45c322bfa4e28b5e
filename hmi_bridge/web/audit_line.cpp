#include "hmi_bridge/web/audit_line.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::hmi::web {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of_json(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Of a sequence of two or three bytes of valid UTF-8, 0 of any other.
unsigned code_point(std::string_view at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(at[i])); };
    if (at.size() >= 2 && (byte(0) & 0xe0) == 0xc0) return (byte(0) & 0x1f) << 6 | (byte(1) & 0x3f);
    if (at.size() >= 3 && (byte(0) & 0xf0) == 0xe0) return (byte(0) & 0x0f) << 12 | (byte(1) & 0x3f) << 6 | (byte(2) & 0x3f);
    return 0;
}

/// C1, line and paragraph separators, marks and overrides of direction, the mark of byte order.
bool is_unseen(unsigned point) {
    return (point >= 0x80 && point < 0xa0) || (point >= 0x200b && point <= 0x200f) || (point >= 0x2028 && point <= 0x202e) ||
           (point >= 0x2060 && point <= 0x206f) || point == 0x61c || point == 0xfeff;
}

}  // namespace

Json bounded(const Json& object) {
    const auto text = text_of_json(object);
    if (text.size() <= longest_in_audit) return object;
    return Json{{"begins", text.substr(0, longest_in_audit / 4)}, {"bytes", text.size()}};
}

std::string audit_text(const Json& line) {
    const auto text = text_of_json(line);
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const auto point = text[at] == 0x7f ? 0x7fu : code_point(std::string_view(text).substr(at));
        if (point != 0x7f && !is_unseen(point)) {
            out.push_back(text[at++]);
            continue;
        }
        out += fmt::format("\\u{:04x}", point);
        at += point == 0x7f ? 1 : point < 0x800 ? 2 : 3;
    }
    return out;
}

bool RefusalBudget::take(std::string_view who, Instant now) {
    auto found = buckets_.find(who);
    if (found == buckets_.end()) found = buckets_.emplace(std::string(who), Bucket{0, now, now, 0}).first;
    auto& bucket = found->second;
    bucket.used = std::max(0.0, bucket.used - to_seconds(now - bucket.at) / to_seconds(one_more));
    bucket.at = now;
    if (bucket.used + 1 <= at_once) {
        bucket.used += 1;
        return true;
    }
    if (bucket.times++ == 0) bucket.since = now;
    return false;
}

std::optional<RefusalBudget::Unwritten> RefusalBudget::next_unwritten(Instant now, bool all) {
    for (auto one = buckets_.begin(); one != buckets_.end();) {
        auto& bucket = one->second;
        if (bucket.times > 0 && (all || now - bucket.since >= told_after)) return Unwritten{one->first, std::exchange(bucket.times, 0)};
        const bool forgotten = bucket.times == 0 && now - bucket.at > std::chrono::minutes{5};
        one = forgotten ? buckets_.erase(one) : std::next(one);
    }
    return std::nullopt;
}

}  // namespace taktwerk::hmi::web
