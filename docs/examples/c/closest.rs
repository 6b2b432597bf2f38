// A tetrahedron, two rays and two points, from Rust:
//   rustc -O closest.rs -l raylanes
use std::ffi::CStr;
use std::os::raw::{c_char, c_void};
use std::ptr::{null, null_mut};

#[repr(C)]
struct Ray {
    origin: [f32; 3],
    tmin: f32,
    direction: [f32; 3],
    tmax: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Hit {
    t: f32,
    u: f32,
    v: f32,
    primitive: u32,
}

extern "C" {
    fn raylanes_last_message() -> *const c_char;
    fn raylanes_bvh_create(tree: *mut *mut c_void, vertices: *const [f32; 3], count: usize, stride: usize,
                           triangles: *const [u32; 3], triangle_count: usize, triangle_stride: usize,
                           options: *const c_void) -> i32;
    fn raylanes_bvh_closest(tree: *const c_void, rays: *const Ray, n: usize, stride: usize, hits: *mut Hit,
                            hit_stride: usize, options: *const c_void) -> i32;
    fn raylanes_bvh_locate(tree: *const c_void, points: *const [f32; 3], n: usize, stride: usize,
                           locations: *mut u8, options: *const c_void) -> i32;
    fn raylanes_bvh_destroy(tree: *mut c_void);
}

fn check(status: i32) {
    let message = unsafe { CStr::from_ptr(raylanes_last_message()) };
    assert!(status == 0, "{}", message.to_string_lossy());
}

fn main() {
    let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let down = |origin| Ray { origin, tmin: 0., direction: [0., 0., -1.], tmax: f32::INFINITY };
    let rays = [down([0.25, 0.25, 2.]), down([2., 2., 2.])];
    let points = [[0.125, 0.125, 0.125], [2., 2., 2.]];
    let (mut tree, mut hits, mut locations) = (null_mut(), [Hit::default(); 2], [0; 2]);
    unsafe {
        check(raylanes_bvh_create(&mut tree, vertices.as_ptr(), 4, 0, triangles.as_ptr(), 4, 0, null()));
        check(raylanes_bvh_closest(tree, rays.as_ptr(), 2, 0, hits.as_mut_ptr(), 0, null()));
        check(raylanes_bvh_locate(tree, points.as_ptr(), 2, 0, locations.as_mut_ptr(), null()));
        raylanes_bvh_destroy(tree);
    }
    println!("triangle {} at t = {}", hits[0].primitive, hits[0].t);
    println!("{}", if hits[1].primitive == u32::MAX { "no hit" } else { "hit" });
    println!("inside: {} {}", locations[0], locations[1]);
}
