#include "hmi_bridge/web/lcm_offer.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/web/json_text.hpp"

namespace taktwerk::hmi::web {
namespace {

using Json = nlohmann::ordered_json;

LcmOffer cannot(std::string why) {
    LcmOffer offer;
    offer.why_not = std::move(why);
    return offer;
}

const Json* member(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

}  // namespace

LcmOffer read_lcm_offer(const Json& hello) {
    const auto* lcm = hello.is_object() ? member(hello, "lcm") : nullptr;
    if (lcm == nullptr || !lcm->is_object())
        return cannot("the machine's runtime is of a version that does not publish whole states over LCM");
    if (const auto why = text_in(*lcm, "why"); !why.empty()) return cannot("the machine does not publish over LCM: " + why);
    auto url = parse_lcm_url(text_in(*lcm, "url"));
    if (!url) return cannot("the machine names no URL of LCM that can be listened to: " + url.error().what);
    if (url->provider == LcmUrl::Provider::memq) return cannot("the machine publishes in its own process alone (memq://)");
    if (url->leaves_host())
        return cannot(
            fmt::format("the machine publishes with ttl={}: its group is shared with a network, where anybody could say what it does. Set "
                        "ttl=0 in `lcm: {{url: ...}}`",
                        url->ttl));
    const auto *rate = member(*lcm, "rate_hz"), *run = member(*lcm, "run");
    if (rate == nullptr || !rate->is_number() || rate->get<double>() < LcmOffer::least_rate_hz)
        return cannot(fmt::format("the machine publishes less than {} times a second. Raise `hmi: {{rate: ...}}` in its machine file",
                                  LcmOffer::least_rate_hz));
    if (run == nullptr || !run->is_number_integer() || run->get<std::int64_t>() <= 0)
        return cannot("the machine does not say which run of it is published");
    LcmOffer offer;
    offer.url = std::move(*url);
    offer.run = run->get<std::int64_t>();
    return offer;
}

}  // namespace taktwerk::hmi::web
