"""What columns of flight logs are called: the words behind the guesses of `alula new`."""

from __future__ import annotations

import re

from alula.base.units import find_unit, known_channel

# Alula's name -> spellings, lower case without blanks, underscores and signs.
WORDS: dict[str, str] = {
    "t": "t time times timestamp timestamps elapsedtime timesec tsec timeus timems gpstime simtime",
    "ax": "ax nx accx accelx xacc longacc axcg accelerationx bodyax axbody blongacc longitudinalacc"
    " accelxbody accelforward",
    "ay": "ay ny accy accely yacc latacc aycg accelerationy bodyay aybody blatacc lateralacc",
    "az": "az nz accz accelz zacc normacc azcg accelerationz bodyaz azbody normalacc bnormacc",
    "p": "p rollrate pb gyrox gyrx pbody bodyangularratep brollrate omegax wx ratep",
    "q": "q pitchrate qb gyroy gyry qbody bpitchrate omegay wy rateq",
    "r": "r yawrate rb gyroz gyrz rbody byawrate omegaz wz rater",
    "pdot": "pdot rollacceleration rollacc dpdt",
    "qdot": "qdot pitchacceleration pitchacc dqdt",
    "rdot": "rdot yawacceleration yawacc drdt",
    "phi": "phi roll bank bankangle rollangle eulerroll rollattitude eulerangleroll",
    "theta": "theta the pitch pitchangle pitchattitude eulerpitch euleranglepitch eulertheta",
    "psi": "psi yaw heading hdg yawangle trueheading headingtrue euleryaw headingangle"
    " eulerangleyaw",
    "psi_mag": "magheading magneticheading psimag headingmagnetic",
    "V": "v tas vtas trueairspeed airspeed vt va vtrue airspeedtrue velocitytas ktas",
    "V_cas": "cas vcas calibratedairspeed kcas",
    "V_ias": "ias vias indicatedairspeed kias airspeedindicated",
    "mach": "mach ma machnumber mac",
    "qbar": "qbar dynamicpressure qc qinf pdyn dynpressure qd impactpressure",
    "alpha": "alpha aoa angleofattack alcg alp alphavane vaneaoa attack al alphaboom",
    "beta": "beta aos sideslip angleofsideslip becg betavane sideslipangle ss ssa",
    "h": "h alt altitude baroalt pressurealtitude hp pressalt baroaltitude altitudemsl height"
    " altbaro",
    "h_gps": "hgps gpsalt gpsaltitude gpsheight altgps",
    "h_radio": "radioaltitude radalt hradio radioheight agl hagl",
    "lat": "lat latitude gpslat",
    "lon": "lon long longitude gpslon gpslong lng",
    "north": "north xned posnorth northing pn positionnorth",
    "east": "east yned poseast easting pe positioneast",
    "v_north": "vnorth vn velnorth velocitynorth northvelocity gpsvn vned1",
    "v_east": "veast ve veleast velocityeast eastvelocity gpsve vned2",
    "v_down": "vdown vd veldown velocitydown downvelocity gpsvd vned3",
    "v_ground": "groundspeed gs gspd speedoverground vground",
    "climb_rate": "climbrate altrate verticalspeed vs vspeed roc hdot rateofclimb",
    "rho": "rho airdensity density ambientdensity",
    "temperature": "temperature temp sat oat statictemperature outsideairtemperature airtemp"
    " ambienttemperature",
    "temperature_total": "tat totaltemperature totalairtemperature",
    "pressure": "pressure staticpressure ps pstatic baropressure baro press ambientpressure",
    "de": "de elevator elev deltae elevatorposition elevatordeflection elevatorangle",
    "da": "da aileron ail deltaa aileronposition ailerondeflection",
    "dr": "dr rudder rud deltar rudderposition rudderdeflection rudderdeg",
    "df": "df flap flaps deltaf flapposition flapangle",
    "da_left": "aileronleft leftaileron daleft dal ailleft",
    "da_right": "aileronright rightaileron daright dar ailright",
    "dt": "dt throttle thr throttleposition deltat powerlever throttlepct",
    "stabilizer": "stabilizer stabiliser stab horizontalstabilizer",
    "gear": "gear landinggear gearposition",
    "thrust": "thrust totalthrust fn netthrust",
    "thrust_left": "thrustleft leftthrust thrustl thrust1",
    "thrust_right": "thrustright rightthrust thrustr thrust2",
    "fuel_used": "fuelused fuelburn fuelconsumed",
    "fuel_used_left": "fuelusedleft lhenginefu leftfuelused",
    "fuel_used_right": "fuelusedright rhenginefu rightfuelused",
    "fuel_flow": "fuelflow ff",
    "fuel_flow_left": "fuelflowleft lhenginefmf",
    "fuel_flow_right": "fuelflowright rhenginefmf",
    "mass": "mass grossmass weight",
    "CX": "cx",
    "CY": "cy",
    "CZ": "cz",
    "phat": "phat",
    "qhat": "qhat",
    "rhat": "rhat",
}
_BY_WORD = {word: name for name, words in WORDS.items() for word in words.split()}
_EXACT = {"V": "V", "v": "v", "u": "u", "w": "w", "Cl": "Cl", "CL": "CL", "Cm": "Cm", "Cn": "Cn",
          "CD": "CD", "T": "temperature"}  # fmt: skip
# Source prefixes that say which box wrote the column: 'Ahrs1_Roll', 'Dadc1_tas', 'gps_lat'.
_BOX = re.compile(
    r"^(ahrs|dadc|adc|imu|ins|fms|fcs|nav|efis|sensor|data|flight|state|est)\d*[_. ]+",
    re.IGNORECASE,
)


def without_unit(label: str) -> tuple[str, str]:
    """('alpha', 'deg') from 'alpha_deg', ('p', 'deg/s') from 'p_deg_s'; no unit: (label, '').

    Parts that are a unit may also stand inside: 'eulerAngle_deg_Yaw'. One letter counts as a unit
    only at the end.
    """
    parts = re.split(r"[_ ]+", label)
    for length in (3, 2, 1):
        for i in range(len(parts) - length, 0, -1):
            unit = "/".join(parts[i : i + length])
            last = i + length == len(parts)
            if find_unit(unit) is not None and (last or len(unit) > 1) and not unit.isdigit():
                return "_".join(parts[:i] + parts[i + length :]), unit
    return label, ""


def guess_name(label: str) -> tuple[str, str]:
    """(Alula's name or '', unit that the label itself states or '') for a column's label."""
    label = label.strip()
    if label in _EXACT:
        return _EXACT[label], ""
    if known_channel(label) and label != "v":
        return label, ""
    for text in dict.fromkeys((label, _BOX.sub("", label))):
        name = _BY_WORD.get(_plain(text), "")
        if name:
            return name, ""
        stem, unit = without_unit(text)
        if unit:
            name = _EXACT.get(stem) or _BY_WORD.get(_plain(stem), "")
            if not name and known_channel(stem):
                name = stem
            si = find_unit(unit)
            known = known_channel(name) if name else None
            if known and si and si.si in (known.unit, *known.also):
                return name, unit
    return "", ""


def _plain(label: str) -> str:
    return re.sub(r"[^a-z0-9]", "", label.lower())
