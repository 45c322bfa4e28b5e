#include "runtime/presence_points.hpp"

#include <string>
#include <utility>

#include "runtime/group_presence.hpp"

namespace taktwerk::runtime {

std::vector<IoPoint> presence_points(const ecat::BusConfig& bus) {
    std::vector<IoPoint> points;
    for (const auto& group : group_names(bus))
        for (const auto& [word, shows] : {std::pair{".present", axes::Presence::present}, std::pair{".joining", axes::Presence::joining}}) {
            IoPoint point;
            point.name = group + word;
            point.presence = PresenceInput{group, shows};
            points.push_back(std::move(point));
        }
    return points;
}

}  // namespace taktwerk::runtime
