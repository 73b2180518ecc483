//! The feature `serde`: what is read back is valid.
#![cfg(feature = "serde")]

use bn_core::io::Format;
use bn_core::{Curve, DVec2, Density, DensityFunction, Ensemble, PointSet, Seed};

#[test]
fn sets_are_arrays_of_pairs() {
    let set = PointSet::new(vec![DVec2::new(0.5, 0.25), DVec2::ZERO]).expect("valid");
    let text = serde_json::to_string(&set).expect("serializable");
    assert_eq!(text, "[[0.5,0.25],[0.0,0.0]]");
    assert_eq!(serde_json::from_str::<PointSet>(&text).expect("valid"), set);
    let ensemble = Ensemble::from(set);
    let text = serde_json::to_string(&ensemble).expect("serializable");
    assert_eq!(serde_json::from_str::<Ensemble>(&text).expect("valid"), ensemble);
}

#[test]
fn invalid_sets_are_refused() {
    for text in ["[]", "[[1.0,0.0]]", "[[0.5]]", "[[0.5,-1e-300]]", "[[0.5,null]]"] {
        assert!(serde_json::from_str::<PointSet>(text).is_err(), "{text}");
    }
    for text in ["[]", "[[]]", "[[[0.5,0.5]],[[2.0,0.0]]]"] {
        assert!(serde_json::from_str::<Ensemble>(text).is_err(), "{text}");
    }
}

#[test]
fn small_types_survive() {
    let seed = Seed::new(7).for_set(3);
    let text = serde_json::to_string(&seed).expect("serializable");
    assert_eq!(serde_json::from_str::<Seed>(&text).expect("valid"), seed);
    let density = Density::new(4096);
    let text = serde_json::to_string(&density).expect("serializable");
    assert_eq!(serde_json::from_str::<Density>(&text).expect("valid"), density);
    let curve =
        serde_json::to_value(Curve::new(0.0, 0.5, vec![1.0, f64::NAN])).expect("serializable");
    assert_eq!(curve["values"], serde_json::json!([1.0, null]));
    let back = serde_json::from_value::<Curve>(curve).expect("valid");
    assert!(back.values()[0] == 1.0 && back.values()[1].is_nan() && back.step() == 0.5);
}

#[test]
fn curves_and_densities_are_checked() {
    for text in [
        r#"{"start":0,"step":0.5,"values":[]}"#,
        r#"{"start":0,"step":0.0,"values":[1]}"#,
        r#"{"start":0,"step":-1,"values":[1]}"#,
        r#"{"start":0,"step":1e308,"values":[1,2,3]}"#,
    ] {
        assert!(serde_json::from_str::<Curve>(text).is_err(), "{text}");
    }
    let ramp = DensityFunction::from_fn(4, |p| p.x).expect("valid");
    let text = serde_json::to_string(&ramp).expect("serializable");
    assert_eq!(serde_json::from_str::<DensityFunction>(&text).expect("valid"), ramp);
    for text in [
        r#"{"width":2,"height":1,"values":[1]}"#,
        r#"{"width":1,"height":1,"values":[-1]}"#,
        r#"{"width":1,"height":1,"values":[0]}"#,
    ] {
        assert!(serde_json::from_str::<DensityFunction>(text).is_err(), "{text}");
    }
    assert_eq!(serde_json::to_string(&Format::Npy).expect("serializable"), "\"npy\"");
}
