// A part of a list of VPLs. The list is the VPLs' buffer or, with VPL_ORDER, vpl_order.
#include "bindings.glsl"

#ifdef VPL_ORDER
layout(std430, binding = BINDING_VPL_ORDER) readonly restrict buffer VplOrder { uint vpl_order[]; };
#endif

const uint NO_VPL = 0xffffffffu;

// Every step-th place from `place` on, before `end`.
struct VplList {
    uint place;
    uint step;
    uint end;
    uint vpl;  // index of the VPL in that place, or NO_VPL
};

uint vpl_in(uint place, uint end) {
    if (place >= end) return NO_VPL;
#ifdef VPL_ORDER
    return vpl_order[place];
#else
    return place;
#endif
}

VplList vpl_list(uint first, uint step, uint end) { return VplList(first, step, end, vpl_in(first, end)); }

void advance(inout VplList list) {
    list.place += list.step;
    list.vpl = vpl_in(list.place, list.end);
}
