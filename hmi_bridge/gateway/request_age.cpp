#include "hmi_bridge/gateway/request_age.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::hmi {

namespace {

double in_ms(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

}  // namespace

Duration RequestAge::at(Instant now) const noexcept {
    const auto waited = arrived == Instant{} ? Duration{} : now - arrived;
    return std::max({age, waited, Duration{}});
}

std::optional<Error> RequestAge::refuse_validity(Duration longest) const {
    if (valid_for >= std::chrono::milliseconds{1} && valid_for <= longest) return std::nullopt;
    return Error{"command.bad_value", "", fmt::format("a validity of {:g} ms is outside its range", in_ms(valid_for)),
                 fmt::format("Give 1 to {:g} ms.", in_ms(longest))};
}

std::optional<Error> RequestAge::refuse_age(Instant now) const {
    if (age < -clock_tolerance)
        return Error{"command.stale", "", fmt::format("the client's clock is {:g} ms ahead of the runtime's", in_ms(-age)),
                     "Set the clocks right; a command's age cannot be judged."};
    if (const auto old = at(now); old > valid_for)
        return Error{
            "command.stale", "",
            fmt::format("the command is {:g} ms old and was valid for {:g} ms; it was not carried out", in_ms(old), in_ms(valid_for)),
            "Give it again; if it comes back, the connection or this computer is too slow."};
    return std::nullopt;
}

}  // namespace taktwerk::hmi
