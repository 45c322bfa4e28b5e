#include "axes/tables/cam_check.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

std::vector<CamStep> steps_of(std::span<const CamPoint> points, bool periodic) {
    PreparedCam cam(points.size());
    if (cam.prepare(points, periodic, true, true) != ErrorId::none) return {};
    struct Seam {
        std::size_t point;
        CamValue before, behind;
    };
    std::vector<Seam> seams;
    const auto reaching = [&](double master) { return cam.at(std::nextafter(master, 0.0)); };
    if (periodic) seams.push_back({0, reaching(cam.length()), cam.at(0)});
    const bool falls = points[1].master < points[0].master;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const double master = points[i].master - cam.begin();
        seams.push_back({i, reaching(master), cam.at(master)});
        if (falls) std::swap(seams.back().before, seams.back().behind);
    }
    double fastest = 0, hardest = 0;
    constexpr int looks = 16;  // in a segment: what is large in this cam
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        for (int k = 0; k < looks; ++k) {
            const double master = points[i].master + (points[i + 1].master - points[i].master) * k / looks;
            const auto value = cam.at(master - cam.begin());
            fastest = std::max(fastest, std::abs(value.first));
            hardest = std::max(hardest, std::abs(value.second));
        }
    std::vector<CamStep> steps;
    for (const auto& [point, before, behind] : seams) {
        if (std::abs(behind.first - before.first) > 1e-5 * fastest)
            steps.push_back({CamStep::Of::velocity, point, before.first, behind.first});
        else if (std::abs(behind.second - before.second) > 1e-3 * hardest)
            steps.push_back({CamStep::Of::acceleration, point, before.second, behind.second});
    }
    return steps;
}

std::vector<std::size_t> misfits_of(std::span<const CamPoint> points) {
    std::vector<std::size_t> misfits;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto &from = points[i], &to = points[i + 1];
        if (from.segment == CamSegment::linear || from.segment == CamSegment::spline || from.segment == CamSegment::quintic) continue;
        CamLawCurve curve;
        if (!curve.set(from.segment, to.master - from.master, {from.slave, from.velocity, from.acceleration},
                       {to.slave, to.velocity, to.acceleration}))
            misfits.push_back(i);
    }
    return misfits;
}

}  // namespace taktwerk::axes
