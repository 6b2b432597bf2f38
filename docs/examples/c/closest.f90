! A tetrahedron, two rays and two points, from Fortran:
!   gfortran closest.f90 -lraylanes
program closest
  use, intrinsic :: iso_c_binding
  implicit none
  interface
    function create(tree, vertices, vertex_count, vertex_stride, triangles, triangle_count, &
                    triangle_stride, options) bind(c, name='raylanes_bvhd_create') result(status)
      import
      type(c_ptr), intent(out) :: tree
      real(c_double), intent(in) :: vertices(*)
      integer(c_int32_t), intent(in) :: triangles(*)
      integer(c_size_t), value :: vertex_count, vertex_stride, triangle_count, triangle_stride
      type(c_ptr), value :: options
      integer(c_int) :: status
    end function
    function trace(tree, rays, n, stride, hits, hit_stride, options) &
        bind(c, name='raylanes_bvhd_closest') result(status)
      import
      type(c_ptr), value :: tree, hits, options
      real(c_double), intent(in) :: rays(*)
      integer(c_size_t), value :: n, stride, hit_stride
      integer(c_int) :: status
    end function
    function locate(tree, points, n, stride, locations, options) bind(c, name='raylanes_bvhd_locate') result(status)
      import
      type(c_ptr), value :: tree, options
      real(c_double), intent(in) :: points(*)
      integer(c_int8_t), intent(out) :: locations(*)
      integer(c_size_t), value :: n, stride
      integer(c_int) :: status
    end function
    subroutine destroy(tree) bind(c, name='raylanes_bvhd_destroy')
      import
      type(c_ptr), value :: tree
    end subroutine
  end interface

  type, bind(c) :: hit
    real(c_double) :: t, u, v
    integer(c_int32_t) :: primitive, unused
  end type

  real(c_double), parameter :: vertices(12) = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], endless = huge(endless)
  integer(c_int32_t), parameter :: triangles(12) = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
  real(c_double) :: rays(8, 2) = reshape([0.25d0, 0.25d0, 2d0, 0d0, 0d0, 0d0, -1d0, endless, &
                                          2d0, 2d0, 2d0, 0d0, 0d0, 0d0, -1d0, endless], [8, 2])
  type(hit), target :: hits(2)
  integer(c_int8_t) :: locations(2)
  type(c_ptr) :: tree

  if (create(tree, vertices, 4_c_size_t, 0_c_size_t, triangles, 4_c_size_t, 0_c_size_t, c_null_ptr) /= 0) error stop
  if (trace(tree, rays, 2_c_size_t, 0_c_size_t, c_loc(hits), 0_c_size_t, c_null_ptr) /= 0) error stop
  if (locate(tree, [0.125d0, 0.125d0, 0.125d0, 2d0, 2d0, 2d0], 2_c_size_t, 0_c_size_t, locations, c_null_ptr) /= 0) &
    error stop
  print '(a, i0, a, f3.1)', 'triangle ', hits(1)%primitive, ' at t = ', hits(1)%t
  print '(a)', trim(merge('no hit', 'hit   ', hits(2)%primitive == -1))  ! RAYLANES_NO_PRIMITIVE, all bits set
  print '(a, i0, a, i0)', 'inside: ', locations(1), ' ', locations(2)
  call destroy(tree)
end program
