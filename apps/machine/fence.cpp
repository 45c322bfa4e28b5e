#include "apps/machine/fence.hpp"

#include <linux/capability.h>

#include <array>

#include "core/process_fence.hpp"

namespace taktwerk::apps {

namespace {

constexpr std::array kept{
    CAP_NET_RAW,          CAP_NET_ADMIN, CAP_BPF,     // frames; AF_XDP, also when a cable comes back
    CAP_NET_BIND_SERVICE,                             // Modbus TCP clients at port 502
    CAP_SYS_NICE,         CAP_IPC_LOCK,               // a priority for the cycle, memory that stays
    CAP_DAC_OVERRIDE,     CAP_CHOWN,     CAP_FOWNER,  // root only: what it keeps in somebody's folder, the socket for a group
};

}  // namespace

Result<void> fence_machine() {
    const auto rights = keep_capabilities(kept);
    const auto calls = refuse_foreign_system_calls();  // each for itself: one that is not to be had takes nothing from the other
    return rights ? calls : rights;
}

}  // namespace taktwerk::apps
