#include "sim/devices/terrain.h"

const terrain_t terrain_flat = {.ramp = false};
const terrain_t terrain_platform = {
    .ramp = true, .ramp_start_s = 7.3, .ramp_end_s = 8.0, .height_m = 0.25, .edge_s = 11.0};

double terrain_height_m(const terrain_t *terrain, double t_s)
{
    if (!terrain->ramp || t_s <= terrain->ramp_start_s || t_s >= terrain->edge_s) {
        return 0.0;
    }
    if (t_s >= terrain->ramp_end_s) {
        return terrain->height_m;
    }
    return terrain->height_m * (t_s - terrain->ramp_start_s) / (terrain->ramp_end_s - terrain->ramp_start_s);
}
