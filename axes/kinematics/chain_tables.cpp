#include "axes/kinematics/chain_tables.hpp"

#include <numbers>

namespace taktwerk::axes {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

/// cos(pi/2) is 6e-17 and not 0: of a multiple of 90 degrees sine and cosine are exact.
Frame<double> turned_exactly(std::size_t around, double angle) noexcept {
    const double quarters = angle / right_angle;
    Frame<double> r;
    if (quarters != std::round(quarters)) return turned(around, angle);
    switch (static_cast<long>(quarters) & 3) {
        case 1: r.turn(around, 1, 0); break;
        case 2: r.turn(around, 0, -1); break;
        case 3: r.turn(around, -1, 0); break;
        default: break;
    }
    return r;
}

}  // namespace

JointChain chain_of(const WristArmLengths& l) noexcept {
    const Frame<double> tip = turned_exactly(0, -right_angle), back = turned_exactly(0, right_angle);  // z to where y was, and back
    return {
        {},
        {shifted(l.a1, 0, l.c1) * tip, back * shifted(0, 0, l.c2) * tip, back * shifted(l.a2, l.b, l.c3), tip, back, shifted(0, 0, l.c4)}};
}

JointChain chain_of(const DhTable& table, DhConvention convention) noexcept {
    JointChain chain;
    if (convention == DhConvention::modified) {
        const auto before = [](const DhRow& row) {
            return turned_exactly(0, row.alpha) * shifted(row.a, 0, 0) * turned_exactly(2, row.theta);
        };
        chain.base = before(table[0]);
        for (std::size_t i = 0; i < 6; ++i) {
            chain.link[i] = shifted(0, 0, table[i].d);
            if (i < 5) chain.link[i] = chain.link[i] * before(table[i + 1]);
        }
        return chain;
    }
    chain.base = turned_exactly(2, table[0].theta);
    for (std::size_t i = 0; i < 6; ++i) {
        chain.link[i] = shifted(table[i].a, 0, table[i].d) * turned_exactly(0, table[i].alpha);
        if (i < 5) chain.link[i] = chain.link[i] * turned_exactly(2, table[i + 1].theta);
    }
    return chain;
}

DhTable table_of(const WristArmLengths& l) noexcept {
    constexpr double q = right_angle;
    return {{{.a = l.a1, .alpha = -q, .d = l.c1, .theta = 0},
             {.a = l.c2, .alpha = 0, .d = l.b, .theta = -q},
             {.a = l.a2, .alpha = q, .d = 0, .theta = q},
             {.a = 0, .alpha = -q, .d = l.c3, .theta = 0},
             {.a = 0, .alpha = q, .d = 0, .theta = 0},
             {.a = 0, .alpha = 0, .d = l.c4, .theta = 0}}};
}

JointChain deviated(const JointChain& chain, const LinkDeviations& by) noexcept {
    JointChain real = chain;
    for (std::size_t i = 0; i < 6; ++i) {
        const LinkDeviation& d = by[i];
        real.link[i] = chain.link[i] * shifted(d.shift[0], d.shift[1], d.shift[2]) * turned(0, d.turn[0]) * turned(1, d.turn[1]) *
                       turned(2, d.turn[2]);
    }
    return real;
}

}  // namespace taktwerk::axes
