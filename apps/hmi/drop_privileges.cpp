#include "apps/hmi/drop_privileges.hpp"

#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>

namespace taktwerk::apps {

void drop_privileges() {
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> left{};
    // root's own has to reach the machine's socket, the users and the audit, whose owner may be another, and a port below 1024. Nothing of the bus.
    if (::geteuid() == 0) left[0].permitted = left[0].effective = 1u << CAP_DAC_OVERRIDE | 1u << CAP_NET_BIND_SERVICE;
    ::syscall(SYS_capset, &header, left.data());
}

}  // namespace taktwerk::apps
