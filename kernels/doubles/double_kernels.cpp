// Rays of doubles through trees of doubles, of one path: compiled once per path with its flags and back end; the table
// is the only symbol that leaves the object.
#include "../point/closest_in_tree.hpp"
#include "double_lists.hpp"
#include "double_packets.hpp"
#include "double_points.hpp"
#include "double_streams.hpp"

namespace raylanes {

RAYLANES_UNIT_TABLE(DoubleRayKernels, doubles, closest_double_of_ray, any_double_of_ray,
                    KeptRow<DoubleTreeView, double>{closest_kept_double, any_kept_double},
                    nearest_triangle_of_ray, closest_doubles, any_double,
                    list_all<WalksFrame, DoubleList, NoCounters>, closest_double_stream, any_double_stream,
                    double_stream_bytes, packet_doubles, double_packet_bytes, closest_of_point<DoublePoints>,
                    closest_of_points<DoublePoints, NoCounters>)

}  // namespace raylanes
