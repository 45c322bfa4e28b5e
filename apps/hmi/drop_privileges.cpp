#include "apps/hmi/drop_privileges.hpp"

#include <linux/capability.h>
#include <unistd.h>

#include <array>
#include <span>

#include "core/process_fence.hpp"

namespace taktwerk::apps {

Result<void> drop_privileges() {
    // root's own has to reach the machine's socket, the users and the audit, whose owner may be another, and a port below 1024. Nothing of the bus.
    constexpr std::array of_root{CAP_DAC_OVERRIDE, CAP_NET_BIND_SERVICE};
    const auto rights = keep_capabilities(std::span(of_root).first(::geteuid() == 0 ? of_root.size() : 0));
    const auto calls = refuse_foreign_system_calls();
    return rights ? calls : rights;
}

}  // namespace taktwerk::apps
