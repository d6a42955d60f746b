//! The twins are alike.

use std::collections::BTreeMap;
use std::mem::{offset_of, size_of};

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Binding, Module, ScalarKind, TypeInner, VectorSize};

use super::*;

fn parse(shader: Shader) -> Module {
    naga::front::wgsl::parse_str(shader.source)
        .unwrap_or_else(|e| panic!("{}: {}", shader.name, e.emit_to_string(shader.source)))
}

#[test]
fn every_shader_is_valid_without_extensions() {
    for shader in ALL {
        let module = parse(shader);
        let result =
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        assert!(result.is_ok(), "{}: {:?}", shader.name, result.err());
        assert!(
            module
                .global_variables
                .iter()
                .all(|(_, v)| { !matches!(v.space, naga::AddressSpace::Storage { .. }) }),
            "{} uses a storage buffer, which WebGL 2 does not have",
            shader.name
        );
    }
}

/// Byte offset of each member of a WGSL struct, and the size of the whole.
fn members(module: &Module, name: &str) -> (BTreeMap<String, u32>, u32) {
    for (_, ty) in module.types.iter() {
        if let (Some(found), TypeInner::Struct { members, span }) = (&ty.name, &ty.inner)
            && found == name
        {
            let offsets = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset));
            return (offsets.collect(), *span);
        }
    }
    panic!("no struct {name}");
}

#[test]
fn frame_uniforms_are_laid_out_alike() {
    for shader in ALL {
        let (offsets, span) = members(&parse(shader), "Frame");
        let twin = FrameUniforms::OFFSETS;
        assert_eq!(offsets.len(), twin.len(), "{}: members of Frame", shader.name);
        for (name, offset) in twin {
            assert_eq!(offsets.get(*name), Some(&(*offset as u32)), "{}: {name}", shader.name);
        }
        assert_eq!(span as usize, size_of::<FrameUniforms>(), "{}: size of Frame", shader.name);
    }
}

/// Number of components and kind of scalar at each location of a vertex input struct.
fn inputs(module: &Module, name: &str) -> BTreeMap<u32, (u8, ScalarKind)> {
    let mut found = BTreeMap::new();
    for (_, ty) in module.types.iter() {
        let TypeInner::Struct { members, .. } = &ty.inner else { continue };
        if ty.name.as_deref() != Some(name) {
            continue;
        }
        for member in members {
            let Some(Binding::Location { location, .. }) = member.binding else { continue };
            let shape = match module.types[member.ty].inner {
                TypeInner::Scalar(scalar) => (1, scalar.kind),
                TypeInner::Vector { size: VectorSize::Bi, scalar } => (2, scalar.kind),
                TypeInner::Vector { size: VectorSize::Tri, scalar } => (3, scalar.kind),
                TypeInner::Vector { size: VectorSize::Quad, scalar } => (4, scalar.kind),
                ref other => panic!("{name} at {location} is {other:?}"),
            };
            found.insert(location, shape);
        }
    }
    found
}

fn shape(format: AttributeFormat) -> (u8, ScalarKind, u64) {
    match format {
        AttributeFormat::Float32x2 => (2, ScalarKind::Float, 8),
        AttributeFormat::Float32x3 => (3, ScalarKind::Float, 12),
        AttributeFormat::Unorm8x4 => (4, ScalarKind::Float, 4),
        AttributeFormat::Snorm16x4 => (4, ScalarKind::Float, 8),
        AttributeFormat::Uint8x4 => (4, ScalarKind::Uint, 4),
        AttributeFormat::Uint32 => (1, ScalarKind::Uint, 4),
    }
}

fn check_attributes(attributes: &[Attribute], size: usize) {
    let mut end = 0;
    for attribute in attributes {
        assert_eq!(attribute.offset, end, "attributes follow one another");
        end += shape(attribute.format).2;
    }
    assert_eq!(end as usize, size, "the attributes cover the struct");
}

#[test]
fn vertices_are_read_as_they_are_written() {
    check_attributes(&LinePoint::ATTRIBUTES, size_of::<LinePoint>());
    check_attributes(&MeshVertex::ATTRIBUTES, size_of::<MeshVertex>());
    assert_eq!(offset_of!(LinePoint, color), 12, "colour of a point");
    assert_eq!(offset_of!(LinePoint, ordinal), 16, "ordinal of a point");
    assert_eq!(offset_of!(LinePoint, info), 20, "info of a point");
    assert_eq!(offset_of!(MeshVertex, normal), 12, "normal of a corner");
    assert_eq!(offset_of!(MeshVertex, color), 20, "colour of a corner");
    assert_eq!(offset_of!(MeshVertex, texcoord), 24, "texture coordinates of a corner");

    let lines = inputs(&parse(LINES), "Segment");
    let both = LinePoint::ATTRIBUTES.iter().chain(&LinePoint::ATTRIBUTES);
    assert_eq!(lines.len(), 8, "two points a segment");
    for ((location, found), attribute) in lines.into_iter().zip(both) {
        let (components, kind, _) = shape(attribute.format);
        assert_eq!(found, (components, kind), "location {location} of a segment");
    }
    let mesh = inputs(&parse(MESH), "Corner");
    assert_eq!(mesh.len(), MeshVertex::ATTRIBUTES.len(), "inputs of a corner");
    for ((location, found), attribute) in mesh.into_iter().zip(&MeshVertex::ATTRIBUTES) {
        let (components, kind, _) = shape(attribute.format);
        assert_eq!(found, (components, kind), "location {location} of a corner");
    }
}

/// The value of a named `u32` or `f32` constant.
fn constant(module: &Module, name: &str) -> f64 {
    let (_, constant) = module
        .constants
        .iter()
        .find(|(_, c)| c.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no constant {name}"));
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::U32(v)) => f64::from(v),
        naga::Expression::Literal(naga::Literal::F32(v)) => f64::from(v),
        ref other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn codes_have_one_meaning() {
    let lines = parse(LINES);
    assert_eq!(constant(&lines, "ROLE_START"), f64::from(role::START), "start");
    assert_eq!(constant(&lines, "ROLE_LAST"), f64::from(role::LAST), "last");
    assert_eq!(constant(&lines, "ROLE_ANNOTATION"), f64::from(role::ANNOTATION), "annotation");
    assert_eq!(constant(&lines, "ROLE_DIMMED"), f64::from(role::DIMMED), "dimmed");
    assert_eq!(constant(&lines, "KIND_SHIFT"), f64::from(role::KIND_SHIFT), "kind");
    let stops = (layout::CODE_STOPS, layout::CODE_LOWEST);
    assert_eq!(constant(&lines, "CODE_STOPS"), f64::from(stops.0), "range of radiance");
    assert_eq!(constant(&lines, "CODE_LOWEST"), f64::from(stops.1), "lowest radiance");
    assert_eq!(constant(&lines, "ORDINAL_BITS"), f64::from(ORDINAL_BITS), "ordinal");
    let [codes, lowest] = THROUGHPUT_CODE;
    assert_eq!(constant(&lines, "THROUGHPUT_CODES"), f64::from(codes), "codes a stop");
    assert_eq!(constant(&lines, "THROUGHPUT_LOWEST"), f64::from(lowest), "lowest throughput");
    let mesh = parse(MESH);
    let kinds = [
        ("KIND_TRANSPARENT", material_kind::TRANSPARENT),
        ("KIND_EMITTER", material_kind::EMITTER),
        ("KIND_MIRROR", material_kind::MIRROR),
    ];
    for (name, kind) in kinds {
        assert_eq!(constant(&mesh, name), f64::from(kind), "{name}");
    }
}

#[test]
fn small_numbers_share_a_word() {
    let parts = |word: u32| (word & 0xff_ffff, word >> 24 & 15, word >> 28);
    assert_eq!(parts(path_word(0x0100_0007, 1.0, 1)), (7, 15, 0), "the number wraps");
    assert_eq!(parts(path_word(9, 0.5, 5)), (9, 8, 2), "four to seven steps");
    assert_eq!(parts(path_word(9, f32::NAN, u32::MAX)), (9, 0, 15), "no number is no acceptance");
    assert_eq!(strategy_and_edges(255, 3), 0x3f, "a seed is no strategy");
    assert_eq!(strategy_and_edges(2, 64), 0xf2, "fifteen edges and more");
}

#[test]
fn radiance_survives_its_byte_to_an_eighth_of_a_stop() {
    for stops in [-39.0_f32, -12.3, -1.0, 0.0, 0.4, 7.7, 20.0] {
        let back = decode_radiance(encode_radiance(stops.exp2()));
        assert!((back - stops).abs() <= 0.126, "{stops} came back as {back}");
    }
    assert_eq!(encode_radiance(0.0), 0, "black is the lowest code");
    assert_eq!(encode_radiance(f32::NAN), 0, "no number is the lowest code");
    assert_eq!(encode_radiance(f32::INFINITY), 255, "too bright is the highest code");
}
