#pragma once
// The LCM network that a command listens and speaks on.

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "core/result.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "hmi_bridge/lcm/lcm_url.hpp"
#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::apps {

inline constexpr int room_for_messages = 20'000;  ///< that wait for this process: a second of what a large machine says

struct NetworkOptions {
    std::string url;    ///< empty: $LCM_DEFAULT_URL, else that of every machine which says nothing else
    std::string types;  ///< folder of further .lcm files; empty: ours alone
};
void add_network_options(CLI::App& sub, NetworkOptions& options);

/// A receive buffer as large as the system grants is asked for, where the URL says none. Errors: hmi.lcm_url.
[[nodiscard]] Result<hmi::LcmUrl> url_of(const NetworkOptions& options);
/// Errors: those of url_of() and LcmBus::open().
[[nodiscard]] Result<std::unique_ptr<hmi::LcmBus>> open_network(const NetworkOptions& options);

/// Ours, and those of the folder. Errors: lcm.types, lcm.type_text.
[[nodiscard]] Result<hmi::TypeCatalog> types_of(const NetworkOptions& options);

}  // namespace taktwerk::apps
