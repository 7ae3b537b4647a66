//! Masks of meshes against the exact masks, and meshes that are not drops.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_drop::DropShape;
use downpour_drop::mesh::DropMesh;
use downpour_mask::{ClosedMesh, Mask, MaskError, MaskOptions, View, trace_drop, trace_model};

fn mesh_of(shape: &DropShape, latitudes: u32) -> ClosedMesh {
    let mesh = DropMesh::latitude_longitude(shape, latitudes, 2 * latitudes).unwrap();
    ClosedMesh::new(mesh.positions(), Some(mesh.normals()), mesh.triangles()).unwrap()
}

fn options(degrees: f64) -> MaskOptions {
    MaskOptions {
        size: 96,
        view: View::from_elevation(f64::to_radians(degrees)).unwrap(),
        ..MaskOptions::default()
    }
}

/// Root mean square difference of directions and mean difference of coverage, at the same positions. The two masks
/// have slightly different extents and centers, so directions are compared at the nearest texel well inside.
fn difference(exact: &Mask, model: &Mask, shift: f64) -> (f64, f64) {
    let (mut sum, mut n) = (0.0, 0);
    for row in 0..model.size {
        for column in 0..model.size {
            let t = model.texel(column, row);
            let [x, y] = model.texel_center(column, row);
            let width = exact.texel_width();
            let middle = f64::from(exact.size) * 0.5;
            let (u, v) = (x / width + middle - 0.5, middle - 0.5 - (y + shift) / width);
            let at = |i: f64, j: f64| exact.texel(i as u32, j as u32);
            if !(u >= 0.0 && v >= 0.0 && u < f64::from(exact.size) - 2.0 && v < f64::from(exact.size) - 2.0) {
                continue;
            }
            let corners = [at(u, v), at(u + 1.0, v), at(u, v + 1.0), at(u + 1.0, v + 1.0)];
            if t.coverage < 1.0 || corners.iter().any(|c| c.coverage < 1.0 || c.reflections != t.reflections)
            {
                continue;
            }
            let (fu, fv) = ((u - u.floor()) as f32, (v - v.floor()) as f32);
            for k in 0..3 {
                let top = corners[0].direction[k] * (1.0 - fu) + corners[1].direction[k] * fu;
                let bottom = corners[2].direction[k] * (1.0 - fu) + corners[3].direction[k] * fu;
                let e = f64::from(t.direction[k] - (top * (1.0 - fv) + bottom * fv));
                sum += e * e;
            }
            n += 1;
        }
    }
    assert!(n > 1000, "only {n} texels compared");
    let area = |m: &Mask| {
        m.texels.iter().map(|t| f64::from(t.coverage)).sum::<f64>() * m.texel_width() * m.texel_width()
    };
    ((sum / f64::from(n)).sqrt(), (area(model) / area(exact) - 1.0).abs())
}

/// A finer mesh is closer to its drop of revolution, at second order in the size of its facets.
#[test]
fn meshes_converge_to_the_drop() {
    for (d, degrees) in [(1.0e-3, 0.0), (4.0e-3, 0.0), (4.0e-3, 50.0)] {
        let shape = DropShape::new(d).unwrap();
        let exact = trace_drop(&shape, &options(degrees)).unwrap();
        // The mesh is centered on its centroid, the mask of the drop on the origin of its shape.
        let shift = shape.centroid_height() / shape.equivalent_radius() * exact.view.up()[1];
        let errors: Vec<(f64, f64)> = [16, 32, 64]
            .iter()
            .map(|&n| {
                difference(&exact, &trace_model(&mesh_of(&shape, n), &options(degrees), None).unwrap(), shift)
            })
            .collect();
        println!("d = {d}, {degrees} degrees: {errors:?}");
        assert!(errors[2].0 < 2.0e-3, "{errors:?}");
        assert!(errors[0].0 > 1.5 * errors[1].0, "{errors:?}");
        assert!(errors[2].1 < 7.0e-4, "{errors:?}");
    }
}

#[test]
fn a_mesh_knows_its_diameter() {
    let mesh = mesh_of(&DropShape::new(3.0e-3).unwrap(), 48);
    assert!((mesh.diameter / 3.0e-3 - 1.0).abs() < 2.0e-3, "{}", mesh.diameter);
}

fn cube() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|b| b as f32)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    (corners, triangles)
}

fn refusal(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> String {
    let error = ClosedMesh::new(positions, None, triangles).unwrap_err();
    assert!(matches!(error, MaskError::Mesh { .. }), "{error}");
    error.to_string()
}

#[test]
fn what_is_no_drop_is_refused_with_its_reason() {
    let (positions, triangles) = cube();
    let good = ClosedMesh::new(&positions, None, &triangles).unwrap();
    assert!(
        (good.diameter - 2.0 * downpour_math::ops::f64::cbrt(3.0 / (4.0 * std::f64::consts::PI))).abs()
            < 1.0e-6
    );

    assert!(refusal(&[], &[]).contains("0 vertices"));
    assert!(refusal(&positions, &[]).contains("0 triangles"));
    assert!(refusal(&positions, &triangles[1..]).contains("open: 3 edges"));
    let inside_out: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(refusal(&positions, &inside_out).contains("inside out"));
    let mut flipped = triangles.clone();
    flipped[0].swap(1, 2);
    assert!(refusal(&positions, &flipped).contains("wrong winding"));
    let mut doubled = triangles.clone();
    doubled.push(triangles[0]);
    assert!(refusal(&positions, &doubled).contains("more than two meet"));
    let flat: Vec<_> = positions.iter().map(|p| [p[0], p[1], 0.0]).collect();
    refusal(&flat, &triangles);
    assert!(refusal(&[[1.0, 2.0, 3.0]; 8], &triangles).contains("degenerate"));
    let mut out_of_range = triangles.clone();
    out_of_range[3][1] = 8;
    assert!(refusal(&positions, &out_of_range).contains("triangle 3"));
    for bad in [f32::NAN, f32::INFINITY] {
        let mut broken = positions.clone();
        broken[5][1] = bad;
        assert!(refusal(&broken, &triangles).contains("vertex 5"));
    }
    assert!(ClosedMesh::new(&positions, Some(&[[0.0, 1.0, 0.0]; 3]), &triangles).is_err());
}

#[test]
fn poles_and_seams_of_a_file_do_not_open_a_mesh() {
    // Vertices doubled at every triangle, as a file with face normals has them, and a collapsed triangle.
    let (positions, triangles) = cube();
    let split: Vec<[f32; 3]> = triangles.iter().flatten().map(|&i| positions[i as usize]).collect();
    let mut faces: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    faces.push([0, 0, 1]);
    let mesh = ClosedMesh::new(&split, None, &faces).unwrap();
    assert_eq!(mesh.triangles.len(), 12);
}
