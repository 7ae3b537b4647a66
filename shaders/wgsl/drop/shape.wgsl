// Equilibrium shape of a falling drop: r(theta) = a (1 + sum over n = 0..10 of c_n cos(n theta)).
// Source: C. Chuang, K. V. Beard, J. Atmos. Sci. 47(11), 1990, table 1; eq. 1 of Rousseau et al. 2006.
// a: radius of the sphere of equal volume, the unit of length here. theta: angle from the downward axis.
// Everything is a function of x = cos(theta): cos(n theta) is the Chebyshev polynomial T_n(x), so the sum is
// Clenshaw's recurrence: no trigonometry, and no special case at the poles.
// Limits: x in [-1, 1]; the coefficients come from the host, normalized to the volume of the sphere.
// Twin: downpour_drop::shape.

// c_0 to c_10, and a padding 0.
struct DropShapeCoefficients {
    c0: vec4f,
    c1: vec4f,
    c2: vec4f,
}

// rho = r / a.
fn drop_shape_radius(c: DropShapeCoefficients, x: f32) -> f32 {
    let two_x = x + x;
    let b10 = c.c2.z;
    let b9 = c.c2.y + two_x * b10;
    let b8 = c.c2.x + two_x * b9 - b10;
    let b7 = c.c1.w + two_x * b8 - b9;
    let b6 = c.c1.z + two_x * b7 - b8;
    let b5 = c.c1.y + two_x * b6 - b7;
    let b4 = c.c1.x + two_x * b5 - b6;
    let b3 = c.c0.w + two_x * b4 - b5;
    let b2 = c.c0.z + two_x * b3 - b4;
    let b1 = c.c0.y + two_x * b2 - b3;
    // The 1 is added last: the deformation keeps all its digits.
    return 1.0 + (c.c0.x + x * b1 - b2);
}

// d rho / d x. The derivative of T_n is n U_(n-1): the same recurrence for Chebyshev's second kind.
fn drop_shape_slope(c: DropShapeCoefficients, x: f32) -> f32 {
    let two_x = x + x;
    let b9 = 10.0 * c.c2.z;
    let b8 = 9.0 * c.c2.y + two_x * b9;
    let b7 = 8.0 * c.c2.x + two_x * b8 - b9;
    let b6 = 7.0 * c.c1.w + two_x * b7 - b8;
    let b5 = 6.0 * c.c1.z + two_x * b6 - b7;
    let b4 = 5.0 * c.c1.y + two_x * b5 - b6;
    let b3 = 4.0 * c.c1.x + two_x * b4 - b5;
    let b2 = 3.0 * c.c0.w + two_x * b3 - b4;
    let b1 = 2.0 * c.c0.z + two_x * b2 - b3;
    return c.c0.y + two_x * b1 - b2;
}

// (rho, d rho / d x).
fn drop_shape_radius_slope(c: DropShapeCoefficients, x: f32) -> vec2f {
    return vec2f(drop_shape_radius(c, x), drop_shape_slope(c, x));
}

// Outward unit normal at the point where the ray from the origin along the unit vector `direction` leaves the
// drop, whose axis points up along the unit vector `up`.
// The surface is |P| - rho(x) = 0 with x = -dot(P, up) / |P|. Its gradient is p + (rho' / rho) (up + x p).
fn drop_shape_normal(c: DropShapeCoefficients, direction: vec3f, up: vec3f) -> vec3f {
    let x = -(direction.x * up.x + direction.y * up.y + direction.z * up.z);
    let radius_slope = drop_shape_radius_slope(c, x);
    let q = radius_slope.y / radius_slope.x;
    let along = 1.0 + x * q;
    let gradient = direction * along + up * q;
    let squared = gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z;
    return gradient * (1.0 / sqrt(squared));
}
