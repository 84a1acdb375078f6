//! The case language: what parses, what it means, what is refused and with which words.

use mirrorbench::error::Error;
use mirrorbench::methods::{Case, Changes, Family, Kind, MethodInfo, Param};
use mirrorbench::scene::matches_pattern;
use proptest::prelude::*;

const BASE: MethodInfo = MethodInfo {
    id: "plain",
    title: "A method without parameters",
    paper: "none",
    family: Family::Baseline,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: false,
    refracts: false,
    variants: &["published"],
    params: &[],
    limits: "",
    passes: &[],
    counters: &[],
    new: None,
};

static PLAIN: MethodInfo = MethodInfo { ..BASE };
static SEARCHING: MethodInfo = MethodInfo {
    id: "searching-map",
    variants: &["published", "revised"],
    params: &[
        Param {
            name: "search",
            kind: Kind::Choice(&["vector", "image", "hierarchical"]),
            defaults: &["vector", "hierarchical"],
            needs: None,
            doc: "how the map is searched",
        },
        Param {
            name: "steps",
            kind: Kind::Integer { min: 1, max: 1000 },
            defaults: &["200"],
            needs: Some(("search", &["vector", "image"])),
            doc: "steps along the ray",
        },
        Param {
            name: "angle_deg",
            kind: Kind::Real { min: 0.0, max: 45.0 },
            defaults: &["1"],
            needs: None,
            doc: "largest accepted angle, degrees",
        },
        Param {
            name: "size",
            kind: Kind::IntegerOrAuto { min: 16, max: 4096 },
            defaults: &["300", "auto"],
            needs: None,
            doc: "side of a face, texels",
        },
        Param {
            name: "certificate",
            kind: Kind::Choice(&["off", "on"]),
            defaults: &["off", "on"],
            needs: Some(("variant", &["revised"])),
            doc: "flag rays that crossed what was not stored",
        },
    ],
    ..BASE
};
static METHODS: [&MethodInfo; 2] = [&PLAIN, &SEARCHING];

fn parse(text: &str) -> Case {
    Case::parse(text, &METHODS).unwrap()
}

fn refusal(text: &str) -> String {
    match Case::parse(text, &METHODS) {
        Err(Error::Usage(message)) => message,
        other => panic!("`{text}` gave {other:?}"),
    }
}

#[test]
fn the_default_variant_is_the_first_and_its_defaults_hold() {
    let case = parse("searching-map");
    assert_eq!(case.text, "searching-map@published");
    let [part] = case.parts.as_slice() else { panic!("one part expected") };
    assert_eq!((part.reflectors.as_str(), part.variant), ("*", "published"));
    let expected = ["vector", "200", "1", "300", "off"];
    assert!(part.values.0.iter().map(|(_, v)| v.as_str()).eq(expected));
    assert!(parse("searching-map@revised").parts[0].values.is("search", "hierarchical"));
    assert_eq!(parse("plain@published").text, "plain");
}

#[test]
fn canonical_text_sorts_normalises_and_drops_defaults() {
    let case = parse("searching-map@revised:size=064,search=image,steps=200,angle_deg=1.50");
    assert_eq!(case.text, "searching-map@revised:search=image,angle_deg=1.5,size=64");
}

#[test]
fn hybrids_take_the_first_matching_part() {
    let case = parse("teapot.*=searching-map:steps=9; *=plain");
    assert_eq!(case.text, "teapot.*=searching-map@published:steps=9;*=plain");
    assert_eq!(case.part_for("teapot.body"), Some(0));
    assert_eq!(case.part_for("teapot"), Some(1));
    assert_eq!(parse("ball?=plain").part_for("cube"), None);
    assert!(case.uses("plain") && !case.uses("truth"));
}

#[test]
fn refusals_say_what_is_valid() {
    for (text, parts) in [
        ("serching-map", vec!["did you mean searching-map?", "valid: plain, searching-map"]),
        ("searching-map@revisd", vec!["did you mean revised?", "valid: published, revised"]),
        ("searching-map:stps=3", vec!["did you mean steps?", "search, steps, angle_deg, size"]),
        ("searching-map:steps=0", vec!["steps=`0`", "an integer from 1 to 1000"]),
        ("searching-map:angle_deg=nan", vec!["a number from 0 to 45"]),
        ("searching-map:size=big", vec!["auto or an integer from 16 to 4096"]),
        ("searching-map:search=fast", vec!["one of vector, image, hierarchical"]),
        ("searching-map:steps", vec!["`steps` is not key=value"]),
        ("searching-map:", vec!["is not key=value"]),
        ("searching-map:steps=3,steps=4", vec!["steps is given twice"]),
        (
            "searching-map:search=hierarchical,steps=3",
            vec!["steps means nothing with search=hierarchical", "needs search=vector or image"],
        ),
        ("searching-map:certificate=on", vec!["needs variant=revised"]),
        ("plain:x=1", vec!["there are none"]),
        ("*=plain;ball=plain", vec!["`ball` is never reached"]),
        ("a b=plain", vec!["`a b` is no reflector pattern"]),
        ("", vec!["there is no method ``"]),
    ] {
        let message = refusal(text);
        assert!(!message.contains('\n'), "{message}");
        for part in parts {
            assert!(message.contains(part), "`{text}` said: {message}");
        }
    }
}

#[test]
fn varying_sets_one_parameter_and_checks_it() {
    let case = parse("ball=searching-map:steps=9,angle_deg=2;*=plain");
    let varied = case.with("searching-map", "steps", "12", &METHODS).unwrap();
    assert_eq!(varied.text, "ball=searching-map@published:steps=12,angle_deg=2;*=plain");
    assert!(case.with("searching-map", "steps", "0", &METHODS).is_err());
    assert_eq!(
        parse("plain").with("searching-map", "steps", "3", &METHODS).unwrap(),
        parse("plain")
    );
}

#[test]
fn folders_are_short_and_free_of_separators() {
    assert_eq!(parse("searching-map:steps=9").folder(), "searching-map@published_steps=9");
    let long = (0..20).map(|i| format!("ball{i}=plain")).collect::<Vec<_>>().join(";");
    let folder = parse(&long).folder();
    assert!(folder.len() <= 120 && !folder.contains(['/', ';', ':', '*']), "{folder}");
}

/// Any valid text for the searching map: parameters in any order, spelt in any valid way.
fn searching_text() -> impl Strategy<Value = String> {
    let pairs = (
        proptest::option::of(prop_oneof!["vector", "image"].prop_map(|s| format!("search={s}"))),
        proptest::option::of((1..=1000u32).prop_map(|n| format!("steps={n:04}"))),
        proptest::option::of((0.0..=45.0f64).prop_map(|a| format!("angle_deg={a:e}"))),
        proptest::option::of(prop_oneof![
            Just("size=auto".to_owned()),
            (16..=4096u32).prop_map(|n| format!("size={n}"))
        ]),
    );
    let shuffled = pairs.prop_map(|(a, b, c, d)| [a, b, c, d].into_iter().flatten().collect());
    (shuffled.prop_flat_map(|v: Vec<String>| Just(v).prop_shuffle()), any::<bool>()).prop_map(
        |(pairs, named)| {
            let head = if named { "searching-map@published" } else { "searching-map" };
            if pairs.is_empty() { head.to_owned() } else { format!("{head}:{}", pairs.join(",")) }
        },
    )
}

proptest! {
    #[test]
    fn canonical_text_parses_to_itself(
        parts in proptest::collection::vec(("[a-z]{1,6}[.*?]?", searching_text()), 0..3),
        last in searching_text(),
    ) {
        let hybrid: Vec<String> = parts
            .iter()
            .enumerate()
            .map(|(i, (pattern, text))| format!("{i}{pattern}={text}"))
            .chain([if parts.is_empty() { last.clone() } else { format!("*={last}") }])
            .collect();
        let case = parse(&hybrid.join(";"));
        prop_assert_eq!(parse(&case.text), case);
    }

    #[test]
    fn any_text_is_either_canonical_after_one_parse_or_refused_in_one_line(text in "\\PC{0,40}") {
        match Case::parse(&text, &METHODS) {
            Ok(case) => prop_assert_eq!(&parse(&case.text).text, &case.text),
            Err(error) => prop_assert!(!error.to_string().contains('\n')),
        }
    }

    #[test]
    fn a_pattern_made_from_a_name_matches_it(name in "[a-z.]{0,12}", mask in any::<[u8; 12]>()) {
        let pattern: String = name
            .chars()
            .zip(mask)
            .map(|(c, m)| match m % 3 { 0 => '?', 1 => '*', _ => c })
            .collect();
        prop_assert!(matches_pattern(&pattern, &name));
    }
}
